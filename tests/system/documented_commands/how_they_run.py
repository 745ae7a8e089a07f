"""How documented commands are run that cannot be run as they stand, each with its reason. Everything else is run word by
word, in a folder that has what it names."""
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Instead:
    """Runs these in the command's place. Words of them are as in a shell."""
    reason: str
    commands: list
    exit_code: int = 0
    says: str = ""                             # in what they say
    until: str = ""                            # ends it by Ctrl-C once it has said this
    removes: list = field(default_factory=list)  # what is there from another way of doing the same


SYNOPSIS = "a synopsis: run with every option that it has"
PLACEHOLDERS = "words in capitals stand for something"
NO_CAMERA = "no camera is there: a recording stands for it, as capture.device may name one"
# Widths and frames are small, so that all of it takes a minute.
SMALL = "--width 160 --height 120 --frames 3"

INSTEAD = {
    "edgeslam run --config FILE [--source INPUT] [--record DIR] [--map-in FILE] [--map-out FILE]": Instead(
        SYNOPSIS, ["edgeslam run --config my_robot.yaml --source my_recording --record recorded --map-in saved.map "
                   "--map-out new.map"]),
    "edgeslam view INPUT [--config FILE] [--port PORT] [--map-in FILE]": Instead(
        SYNOPSIS + "; it waits for a browser", ["edgeslam view my_recording --config my_robot.yaml --port 0 --map-in saved.map"],
        until="the page is at http://127.0.0.1:"),
    "edgeslam view FOLDER|VIDEO|RECORDING [--config FILE] [--port PORT]": Instead(
        SYNOPSIS + "; it waits for a browser", ["edgeslam view my_recording --config my_robot.yaml --port 0"],
        until="the page is at http://127.0.0.1:"),
    "edgeslam view failure": Instead(
        "it waits for a browser, and the usual port may be taken", ["edgeslam view failure --port 0"],
        until="the page is at http://127.0.0.1:"),
    "edgeslam replay INPUT [--config FILE] [--output DIR] [--map-in FILE] [--map-out FILE] "
    "[--imu] [--wheels] [--realtime [--pace N] [--record DIR] [--lcm]] [--drawings N]": Instead(
        SYNOPSIS, ["edgeslam replay my_recording --config my_robot.yaml --output r1 --map-in saved.map --map-out new.map "
                   "--drawings 2",
                   "edgeslam replay my_recording --output r2 --realtime --pace 4 --record r2_recorded --lcm",
                   "edgeslam simulate panels_textured --output with_inertia --width 320 --height 240 --frames 90 --imu --wheels",
                   "edgeslam replay with_inertia --imu --output r3", "edgeslam replay with_inertia --wheels --output r4",
                   "edgeslam replay with_inertia --imu --wheels --output r5"]),
    "edgeslam replay DIR": Instead(PLACEHOLDERS, ["edgeslam replay my_recording"]),
    "edgeslam replay VIDEO": Instead(PLACEHOLDERS + "; no video is there", ["edgeslam replay my_recording"]),
    "edgeslam replay RECORDING --realtime --lcm": Instead(
        PLACEHOLDERS, ["edgeslam replay my_recording --realtime --lcm"]),
    "edgeslam evaluate ESTIMATE GROUNDTRUTH [--alignment similarity|rigid|none] [--tolerance S] [--delta S] [--json FILE]":
        Instead(SYNOPSIS, [f"edgeslam evaluate result/trajectory.txt groundtruth.txt --alignment {alignment} "
                           "--tolerance 0.02 --delta 1 --json error.json" for alignment in ("similarity", "rigid", "none")]),
    "edgeslam benchmark DIR [--output DIR] [--jobs N] [--config FILE] [--only NAME,...] [--again] [--slurm [OPTIONS]]": Instead(
        SYNOPSIS + "; nothing is left for Slurm, which tests/system/slurm has",
        ["edgeslam benchmark my_data --output all --jobs 1 --config my_robot.yaml --only first,second --again",
         "edgeslam benchmark my_data --output all --config my_robot.yaml --slurm"]),
    "edgeslam report RUN RUN [RUN...] | DIR [--output FILE.html]": Instead(
        SYNOPSIS, ["edgeslam report before after", "edgeslam report before after result --output three.html",
                   "edgeslam report all --output all.html"]),
    "edgeslam simulate SCENE --output DIR [--frames N] [--seed N] [--fps F] [--width PX] [--height PX] [--fisheye] "
    "[--exposure MS] [--readout MS] [--noise GREY] [--speed FACTOR] [--cover|--shake|--still|--turn FIRST:COUNT] "
    "[--turn-angle DEG] [--imu] [--wheels [--slip FIRST:COUNT]] "
    "[--force]": Instead(
        SYNOPSIS, [f"edgeslam simulate {scene} --output made --seed 2 --fps 20 {SMALL} --imu --fisheye --exposure 2 "
                   "--readout 24 --noise 3 --speed 2 --cover 0:1 --shake 1:1 --still 2:1 --turn 2:1 --turn-angle 60 --wheels "
                   "--slip 3:1 --force"
                   for scene in ("panels", "panels_textured", "room", "corridor", "corridor_tiled")]),
    "edgeslam calibrate board --columns N --rows N --square LENGTH --output PDF "
    "[--type chessboard|charuco|aprilgrid] [--paper A4]": Instead(
        SYNOPSIS, [f"edgeslam calibrate board --columns 6 --rows 5 --square 26mm --output {kind}.pdf --type {kind} --paper A4"
                   for kind in ("chessboard", "charuco", "aprilgrid")]),
    "edgeslam calibrate INPUT|--camera DEVICE|--config FILE --board BOARD [--output camera.yaml] [--model MODEL] "
    "[--seconds S] [--force]": Instead(
        SYNOPSIS + "; " + NO_CAMERA,
        ["edgeslam calibrate board_camera --board chessboard:9x6:25mm --output camera.yaml --model "
         "pinhole_radial_tangential --force",
         "edgeslam calibrate --camera board_camera --board chessboard:9x6:25mm --output second.yaml --seconds 60",
         "edgeslam calibrate --config board_robot.yaml --board chessboard:9x6:25mm --output third.yaml"]),
    "edgeslam calibrate --readout RECORDING": Instead(
        PLACEHOLDERS + "; of this one's few frames none tells the readout", ["edgeslam calibrate --readout my_recording"],
        exit_code=1, says="does not tell the readout"),
    "edgeslam calibrate --imu RECORDING [--config FILE] [--output imu.yaml] [--force]": Instead(
        SYNOPSIS, ["edgeslam calibrate --imu swinging --config my_robot.yaml --output imu.yaml --force"]),
    "edgeslam calibrate --imu RECORDING --board BOARD [--config FILE] [--output imu.yaml] [--force]": Instead(
        SYNOPSIS + "; this one shows no board",
        ["edgeslam calibrate --imu short --board chessboard:9x6:25mm --config my_robot.yaml --output board_imu.yaml --force"],
        exit_code=1, says="the board is found in no frame"),
    "edgeslam calibrate --imu": Instead(
        "the name of this way of calibrating", ["edgeslam calibrate --imu"], exit_code=2, says="INPUT is required"),
    "edgeslam calibrate --imu my_recording --output imu.yaml": Instead(
        "this one has few frames and no inertial data",
        ["edgeslam calibrate --imu swinging --output imu.yaml"]),
    "edgeslam map info FILE... [--picture PNG] [--json] [--force]": Instead(
        SYNOPSIS, ["edgeslam map info saved.map robot.map", "edgeslam map info robot.map --json --picture robot.png --force"]),
    "edgeslam map join FILE FILE... --output FILE [--config FILE] [--force]": Instead(
        SYNOPSIS, ["edgeslam map join morning.map evening.map --output joined.map --config my_robot.yaml --force"]),
    "edgeslam map crop FILE --output FILE [--keep-box X:X,Y:Y,Z:Z] [--remove-box X:X,Y:Y,Z:Z]... "
    "[--remove-keyframes FIRST:LAST]... [--remove-map N]... [--map N] [--force]": Instead(
        SYNOPSIS + "; this file has one map only, which is taken out",
        ["edgeslam map crop robot.map --output cropped.map --keep-box -100:100,:,: --remove-box :-50,:,: "
         "--remove-keyframes 0:1 --remove-keyframes 3 --remove-map 0 --map 0 --force"],
        exit_code=2, says="nothing would be left of it"),
    "edgeslam mask RECORDING [--output mask.png] [--force]": Instead(
        SYNOPSIS + "; this one's few frames show too little", ["edgeslam mask my_recording --output mask.png --force"],
        exit_code=2, says="the camera hardly moves"),
    "edgeslam mask my_recording --output mask.png": Instead(
        "its few frames show too little", ["edgeslam mask my_recording --output mask.png"],
        exit_code=2, says="the camera hardly moves"),
    "edgeslam mask my_recording": Instead(
        "its few frames show too little", ["edgeslam mask my_recording"], exit_code=2, says="the camera hardly moves"),
    "edgeslam check-config FILE | --print-default | --print-expert": Instead(
        SYNOPSIS, ["edgeslam check-config my_robot.yaml", "edgeslam check-config --print-default",
                   "edgeslam check-config --print-expert"]),
    "edgeslam check-config FILE": Instead(PLACEHOLDERS, ["edgeslam check-config my_robot.yaml"]),
    "edgeslam cameras [--json]": Instead(SYNOPSIS, ["edgeslam cameras", "edgeslam cameras --json"]),
    "edgeslam record [DEVICE] --output DIR [--config FILE] [--calibration FILE] [--seconds S] [--frames N] "
    "[--keep-free MIB]": Instead(
        SYNOPSIS + "; " + NO_CAMERA,
        ["edgeslam record my_recording --output frames --config my_robot.yaml --calibration my_recording/camera.yaml "
         "--seconds 1 --frames 5 --keep-free 1"]),
    "edgeslam record DEVICE --output frames --seconds 10": Instead(
        PLACEHOLDERS + "; " + NO_CAMERA, ["edgeslam record my_recording --output frames --seconds 10"]),
    "edgeslam listen [--url URL] [--channel NAME]... [--count N]": Instead(
        SYNOPSIS, ["edgeslam listen --url file://heard.log?speed=0 --channel SLAM_STATE --channel SLAM_STATUS --count 5"],
        says="SLAM_STATE #"),
    "edgeslam listen --channel NAME": Instead(
        PLACEHOLDERS + "; it listens until it is ended", ["edgeslam listen --channel SLAM_POSE"], until="SLAM_POSE "),
    "edgeslam listen --channel SLAM_STATUS": Instead(
        "it listens until it is ended", ["edgeslam listen --channel SLAM_STATUS"], until="SLAM_STATUS #"),
    "edgeslam run --config /etc/edgeslam/robot.yaml": Instead(
        "it is not installed here; tests/vm/service.sh runs it so", ["edgeslam run --config my_robot.yaml"]),
    "edgeslam calibrate --camera /dev/video0 --board chessboard:9x6:25mm": Instead(
        NO_CAMERA, ["edgeslam calibrate --camera board_camera --board chessboard:9x6:25mm"]),
    "edgeslam calibrate board_frames --board chessboard:9x6:25mm --output camera.yaml": Instead(
        "the file is there from the other way of calibrating", ["edgeslam calibrate board_frames --board "
                                                                 "chessboard:9x6:25mm --output camera.yaml"],
        removes=["camera.yaml"]),
}

# Words of configurations that stand for something.
IN_CONFIGURATIONS = {"N": "10", "5f0c...": "5f0c5f0c5f0c5f0c5f0c5f0c5f0c5f0c"}
# What looks like a configuration and is none.
NO_CONFIGURATIONS = {}
