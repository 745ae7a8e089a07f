#include "configuration/configuration_keys.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "configuration/configuration_camera.h"

namespace edgeslam {
namespace {

using Keys = std::vector<ConfigurationKey>;

ConfigurationKey heading(const std::string& section, const std::string& documentation) {
  return {section, std::monostate{}, "", 0, 0, documentation};
}

ConfigurationKey forUsers(ConfigurationKey key) {
  key.for_users = true;
  return key;
}

// A number whose default cannot be written: the driver's.
ConfigurationKey withExample(ConfigurationKey key, const std::string& example) {
  key.example = example;
  return forUsers(std::move(key));
}

// A text; with an `example` where it is empty by default.
ConfigurationKey text(const std::string& path, std::string* field, const std::string& documentation,
                      const std::string& example = "") {
  return forUsers({path, field, "", 0, 0, documentation, 1, example});
}

// A key with a reader of its own.
ConfigurationKey special(const std::string& path, const std::string& documentation, const std::string& example) {
  return forUsers({path, std::monostate{}, "", 0, 0, documentation, 1, example});
}

// The camera: its calibration and its place on the robot, and how it is set.
Keys cameraKeys(CameraOptions& capture) {
  Keys keys{
      heading(
          "camera",
          "The camera. Without a calibration here the one beside the recording is used (camera.yaml, EuRoC's "
          "sensor.yaml).\nWhere there is none give width and height alone: a focal length is presumed then, and the "
          "lens found on the way"),
      special("camera.calibration",
              "file with the calibration, relative to this file; or its keys in its place:", "cameras/tum_fr1.yaml"),
      special("camera.model", "pinhole_radial_tangential, or kannala_brandt for a fisheye lens",
              "pinhole_radial_tangential"),
  };
  for (const ConfigurationKey& key : calibrationKeyNames()) keys.push_back(key);
  Keys others{
      special("camera.mask",
              "image of the camera's size, relative to this file: where it is black, images are not looked at, as the "
              "robot's\nown body is in view there (docs/mounting.md); also beside camera.calibration",
              "mask.png"),
      special("camera.body_T_camera",
              "pose of the camera (x right, y down, z forward) on the robot: 4x4 matrix row by row, or translation [m] "
              "and\nunit quaternion (w, x, y, z) (default: the identity)",
              "{translation: [0, 0, 0], quaternion: [1, 0, 0, 0]}"),

      heading("capture",
              "The live camera. `edgeslam cameras` lists what is there, with the lines to put here. What is left out, "
              "the\ndriver chooses. What the camera refuses is told when it is opened, with what it allows"),
      text("capture.device", &capture.device,
           "a name that stays the same camera's: /dev/v4l/by-id/..., /dev/v4l/by-path/..., libcamera:NAME; or a "
           "recording",
           "/dev/v4l/by-id/usb-046d_HD_Pro_Webcam_C920-video-index0"),
      text("capture.format", &capture.format,
           "GREY, Y10, Y12, Y16, NV12, NV21, YU12, YUYV, UYVY, MJPEG, RGB24 or BGR24 (default: of the fastest, the one "
           "of\nthe least work)",
           "YUYV"),
      withExample({"capture.width", &capture.width, "px", 16, 16384,
                   "image width (default: the driver's, or the calibration's)"},
                  "640"),
      withExample({"capture.height", &capture.height, "px", 16, 16384, "image height"}, "480"),
      withExample({"capture.frame_rate", &capture.frame_rate, "frames/s", 0.1, 1000, "default: the fastest up to 30"},
                  "30"),
      special("capture.region", "part of the sensor that is read, [left, top, width, height] [px]",
              "[0, 0, 1280, 960]"),
      special("capture.exposure",
              "auto, or the exposure time [ms]; fixed, it also makes the time stamps those of its middle", "8"),
      withExample({"capture.longest_exposure", &capture.longest_exposure_ms, "ms", 0.01, 1000,
                   "the automatic exposure stays below this, against blur, where the driver lets it be set"},
                  "10"),
      special("capture.gain", "auto, or a number: in the driver's units; for white_balance [K]", "auto"),
      special("capture.white_balance", "", "4500"),
      special("capture.focus", "", "0"),
      special("capture.power_line_frequency", "lights that flicker at 50 or 60 Hz; off or auto", "50"),
      special("capture.controls", "any other control, by the name that `edgeslam cameras` shows",
              "{brightness: 128, sharpness: 3}"),
  };
  std::move(others.begin(), others.end(), std::back_inserter(keys));
  return keys;
}

// The inertial unit that is fixed to the camera.
Keys imuKeys(InertiaConfiguration& inertia) {
  InertialUnit& unit = inertia.unit;
  Keys keys{
      heading("imu",
              "An inertial unit that is fixed to the camera: metres, z up, and poses through blur (docs/inertia.md)"),
      {"imu.enabled", &inertia.is_used, "", 0, 0,
       "its data are used: of live runs from LCM, of recorded frames those that lie beside them"},
      text("imu.channel", &inertia.channel,
           "of LCM, where it is published as edgeslam.imu_t or bot_core.ins_t, with time stamps of CLOCK_MONOTONIC as "
           "the "
           "camera's"),
      special(
          "imu.calibration",
          "file with the unit (imu.yaml, docs/files.md), relative to this file; or its keys in its place:", "imu.yaml"),
      special("imu.imu_T_camera",
              "pose of the camera (x right, y down, z forward) in the unit's frame: 4x4 matrix row by row, or "
              "translation [m]\nand unit quaternion (w, x, y, z)",
              "{translation: [0, 0, 0], quaternion: [1, 0, 0, 0]}"),
      {"imu.gyroscope_noise_density", &unit.rate_noise, "rad/s/sqrt(Hz)", 1e-7, 1, "noise, as data sheets have it"},
      {"imu.gyroscope_random_walk", &unit.rate_walk, "rad/s^2/sqrt(Hz)", 1e-9, 1, "of its bias"},
      {"imu.accelerometer_noise_density", &unit.force_noise, "m/s^2/sqrt(Hz)", 1e-6, 10, "noise"},
      {"imu.accelerometer_random_walk", &unit.force_walk, "m/s^3/sqrt(Hz)", 1e-8, 10, "of its bias"},
      {"imu.time_offset_s", &inertia.time_offset_s, "s", -10, 10,
       "is added to a frame's time to have the unit's (Kalibr's timeshift_cam_imu)"},
  };
  for (ConfigurationKey& key : keys) key.for_users = !key.isHeading();
  return keys;
}

// What `edgeslam run` gives out and keeps.
Keys serviceKeys(ServiceOptions& service, Settings& settings) {
  RecordingSpace& space = settings.recording;
  LcmOptions& lcm = service.lcm;
  ScaleOptions& scale = service.scale;
  ViewerOptions& viewer = service.viewer;
  Ros2Options& ros2 = service.ros2;
  Keys keys{
      heading("lcm", "Messages to the robot's controller"),
      text("lcm.url", &lcm.url, "where messages go (default: LCM_DEFAULT_URL of the environment, or LCM's own)",
           "udpm://239.255.76.67:7667"),
      {"lcm.ttl", &lcm.time_to_live, "", -1, 255,
       "reach of the messages: 0 this computer, 1 the local network; -1: as the URL says"},
      text("lcm.pose_channel", &lcm.pose_channel, "names of the channels"),
      text("lcm.odometry_channel", &lcm.odometry_channel, ""),
      text("lcm.odom_channel", &lcm.odom_channel, ""),
      text("lcm.correction_channel", &lcm.correction_channel, ""),
      text("lcm.state_channel", &lcm.state_channel, ""),
      text("lcm.status_channel", &lcm.status_channel, ""),
      text("lcm.map_channel", &lcm.map_channel, ""),
      text("lcm.map_lines_channel", &lcm.map_lines_channel, ""),
      text("lcm.command_channel", &lcm.command_channel, ""),
      text("lcm.answer_channel", &lcm.answer_channel, ""),
      {"lcm.map_interval_s", &service.map_interval_s, "s", 0, 3600,
       "the map is sent at most so often where it changed; 0: on request only"},

      heading("ros2", "The same for ROS 2, which need not be installed here (docs/ros2.md)"),
      {"ros2.enabled", &ros2.enabled, "", 0, 0,
       "odometry, pose in the map, transforms, map and diagnostics are published for ROS 2"},
      {"ros2.domain", &ros2.domain, "", -1, 232,
       "programs of the same domain hear each other; -1: ROS_DOMAIN_ID of the environment, or 0"},
      text("ros2.namespace", &ros2.topic_namespace,
           "before the topics odom, pose and map_points, which others on the robot may have, too (default: none)",
           "edgeslam"),
      text("ros2.transforms", &ros2.transforms,
           "all: map to odom to body; map_to_odom: another node has odom to body; none"),
      text("ros2.map_frame", &ros2.map_frame, "names of the frames"),
      text("ros2.odom_frame", &ros2.odom_frame, ""),
      text("ros2.body_frame", &ros2.body_frame, "of the robot, in which camera.body_T_camera has the camera"),

      heading("map", "The map on the disk, of `edgeslam run`"),
      text("map.file", &service.map_file,
           "written at the end, on SIGHUP and on command, whole or not at all; relative to the working directory",
           "robot.map"),
      {"map.go_on", &service.goes_on_with_map, "", 0, 0,
       "at the start, continue the map in the file, where there is one: the camera is looked for in it"},
      {"map.frozen", &settings.tracking.map_is_frozen, "", 0, 0,
       "localisation only: the map of --map-in, or in the file, is read at the start, and nothing is added to it or "
       "changed;\nit must be there, and the file is not written"},

      heading("recording", "The flight recorder of live runs"),
      text("recording.folder", &service.recordings_folder,
           "where `edgeslam run` makes a folder for each recording; relative to the working directory", "recordings"),
      {"recording.from_start", &service.records_from_start, "", 0, 0,
       "`edgeslam run` records from the start, not only on command"},
      {"recording.most_megabytes", &space.most_megabytes, "MB", 1, 1e9, "most that a recording takes"},
      {"recording.kept_free_megabytes", &space.kept_free_megabytes, "MB", 0, 1e9,
       "left free for others; at less the recording ends"},

      heading("scale", "Metres a map unit: by command from a known distance, or found by itself"),
      text("scale.source", &scale.source,
           "none: metres by command only; camera_height: over the ground; odometry: of the wheels, by LCM"),
      {"scale.camera_height_m", &scale.height.camera_height_m, "m", 0, 100,
       "of the camera's centre over the ground; 0: not given"},
      {"scale.camera_height_sigma_m", &scale.height.sigma_m, "m", 0, 10, "standard deviation of it"},
      {"scale.ground_tilt_deg", &scale.height.largest_tilt_deg, "deg", 1, 45,
       "largest angle of the ground's normal to the body's z axis (camera.body_T_camera)"},
      text("scale.odometry_channel", &scale.odometry.channel,
           "of bot_core.pose_t: the body's pose in metres, time stamps of CLOCK_MONOTONIC as the camera's", "ODOMETRY"),
      {"scale.odometry_sigma", &scale.odometry.sigma, "", 0, 1,
       "standard deviation of the odometry's own scale (size of the wheels), as a share of it"},
      {"scale.odometry_sigma_per_metre", &scale.odometry.sigma_per_metre, "m", 0.001, 1,
       "standard deviation of a way of 1 m, by slip; grows with the root of the way"},
      {"scale.odometry_window_m", &scale.odometry.window_m, "m", 0.05, 100,
       "way of the body from one comparison with the camera to the next"},
      {"scale.largest_sigma", &scale.largest_sigma, "", 0.001, 1,
       "a scale is refused where its standard deviation is over this share of it"},
      {"scale.metres_per_unit", &scale.metres_per_unit, "m", 0, 1e6,
       "of the saved map that the run continues; 0: not known"},
      {"scale.sigma", &scale.sigma, "", 0, 1, "standard deviation of that, as a share of it"},

      heading("wheels",
              "The robot's wheels as a motion: metres, and poses where the camera sees nothing (docs/wheels.md)"),
      {"wheels.enabled", &settings.wheels.enabled, "", 0, 0,
       "their odometry is used: of live runs from LCM (scale.odometry_channel), of recorded frames where it lies "
       "beside\nthem"},
      {"wheels.planar", &settings.wheels.planar, "", 0, 0,
       "the robot stays on a plane floor: it hardly tilts or rises"},

      heading("viewer", "A page in the browser for people who look on"),
      {"viewer.enabled", &viewer.enabled, "", 0, 0, "`edgeslam run` serves a page that shows the run"},
      text("viewer.address", &viewer.address,
           "address of this computer where it is served: 127.0.0.1 to this computer alone (ssh -L brings it to "
           "others),\n"
           "0.0.0.0 to all"),
      {"viewer.port", &viewer.port, "", 1, 65535, "TCP"},
      text("viewer.token", &viewer.token,
           "who looks on must know it, 16 to 128 letters and digits (openssl rand -hex 16); needed for other addresses",
           "0123456789abcdef0123456789abcdef"),
  };
  for (ConfigurationKey& key : keys) key.for_users = !key.isHeading();
  return keys;
}

Keys methodKeys(Settings& settings) {
  EdgeOptions& edges = settings.edges;
  PointChoiceOptions& points = settings.points;
  TrackerOptions& tracking = settings.tracking;
  OrientationOnlyOptions& orientation_only = tracking.location.orientation_only;
  BlurGateOptions& blur_gate = tracking.blur_gate;
  FramePoseOptions& pose = tracking.location.pose;
  FlowOptions& flow = tracking.location.flow;
  RefinementOptions& refinement = tracking.location.refinement;
  EdgeLockOptions& edge_lock = tracking.location.edge_lock;
  MapReuseOptions& reuse = tracking.map_reuse;
  StraightEdgeOptions& straight_edges = tracking.straight_edges;
  KeyframeOptions& keyframes = tracking.keyframes;
  ViewOptions& view = settings.mapping.view;
  InitialisationOptions& initialisation = settings.mapping.initialisation;
  QualityOptions& quality = initialisation.quality;
  NewPointOptions& new_points = settings.mapping.new_points;
  LocalAdjustmentOptions& adjustment = settings.mapping.local_adjustment;
  BundleOptions& bundle = adjustment.bundle;
  CullingOptions& culling = settings.mapping.culling;
  ThreadOptions& threads = settings.threads;
  return {
      heading("threads", "Threads of a live run; what is not allowed is told and left out"),
      forUsers({"threads.capture_priority", &threads.capture_priority, "", 0, 99,
                "real-time priority (SCHED_FIFO); 0: the usual scheduling"}),
      forUsers({"threads.tracking_priority", &threads.tracking_priority, "", 0, 99, "likewise"}),
      forUsers({"threads.publishing_priority", &threads.publishing_priority, "", 0, 99, "likewise"}),
      forUsers({"threads.mapping_nice", &threads.mapping_nice, "", 0, 19, "nice level"}),
      forUsers({"threads.places_nice", &threads.places_nice, "", 0, 19, "nice level"}),
      forUsers({"threads.tracking_processor", &threads.tracking_processor, "", -1, 1023,
                "the thread keeps to this processor; -1: any"}),
      forUsers({"threads.mapping_processor", &threads.mapping_processor, "", -1, 1023, "likewise"}),
      forUsers({"threads.places_processor", &threads.places_processor, "", -1, 1023, "likewise"}),
      forUsers(
          {"threads.lock_memory", &threads.lock_memory, "", 0, 0, "keeps the program's memory from being swapped out"}),

      heading("edges", "Edges: zero crossings of a difference of Gaussians, joined into chains"),
      {"edges.sigma", &edges.sigma, "px", 0.3, 10, "standard deviation of the narrower Gaussian"},
      {"edges.sigma_ratio", &edges.sigma_ratio, "", 1.05, 4,
       "standard deviation of the wider Gaussian over the narrower's"},
      {"edges.plane_fit_radius", &edges.plane_fit_radius, "px", 1, 7,
       "a plane is fitted over (2 r + 1)^2 pixels of the difference"},
      {"edges.sign_balance", &edges.sign_balance, "", 0, 1, "most |positive - negative| / all signs in that window"},
      {"edges.gradient_threshold", &edges.gradient_threshold, "grey/px", 0, 100, "least gradient across an edge"},
      {"edges.shortest_chain", &edges.shortest_chain, "points", 1, 1000, "shorter chains are no edges"},

      heading("blur_gate", "Blurred frames: told by the sum of the gradients at the edge points"),
      {"blur_gate.share_of_average", &blur_gate.share_of_average, "", 0, 1,
       "less of the average sharpness is blurred; 0 lets all pass"},
      {"blur_gate.forgetting", &blur_gate.forgetting, "", 0, 0.9999, "weight of the past in the average, a frame"},
      {"blur_gate.longest_rejection_s", &blur_gate.longest_rejection_s, "s", 0, 60,
       "after as long without a sharp frame the average starts anew"},

      heading("points", "Choice of the points to track, and how exactly each is measured"),
      forUsers({"points.count", &points.count, "points", 50, 5000, "points tracked at once; fewer are faster"}),
      {"points.spacing", &points.spacing, "px", 1, 100, "least distance between two points"},
      {"points.cell", &points.cell, "px", 4, 1000, "side of a cell of the grid over which points are spread"},
      {"points.corner_share", &points.corner_share, "", 0, 1,
       "most of the points that corner-like ones may take first"},
      {"points.tensor_window", &points.accuracy.tensor_window, "px", 3, 63, "side of the structure tensor's window", 2},
      {"points.corner_ratio", &points.accuracy.corner_ratio, "", 0, 1,
       "corner-like: smaller over larger eigenvalue above this ..."},
      {"points.corner_strength", &points.accuracy.corner_strength, "grey^2/px^2", 0, 10000,
       "... and smaller eigenvalue above this"},
      {"points.noise", &points.accuracy.noise, "grey^2/px^2", 0, 10000,
       "usual noise of the structure tensor; where an image has more, that is measured"},
      {"points.sigma_edge", &points.accuracy.sigma_edge, "px", 0.01, 10,
       "standard deviation of a measurement across an edge"},
      {"points.sigma_corner", &points.accuracy.sigma_corner, "px", 0.01, 10, "the same of a corner-like point"},
      {"points.border", &points.border, "px", 0, 200, "points keep this distance from the image's border"},

      {"points.weigh_edges", &points.accuracy.weigh_edges, "", 0, 0,
       "false counts a point as well known along its edge as across; to measure the gain"},

      heading("pose", "Pose of each frame: robust Gauss-Newton on the edge measurements"),
      {"pose.iterations", &pose.iterations, "", 1, 100, "most Gauss-Newton steps"},
      {"pose.huber", &pose.huber, "sigma", 0.1, 100, "from here on the error of a measurement counts linearly"},
      {"pose.outlier", &pose.outlier, "sigma", 0.1, 100, "from here on a measurement is an outlier"},
      {"pose.fewest", &pose.fewest, "points", 4, 1000, "with fewer measurements or inliers there is no pose"},
      {"pose.unmapped_depth_sigma", &pose.unmapped_depth_sigma, "", 0, 10,
       "of the depth guessed for a track that has none, share of it; 0: such tracks do not help"},
      {"pose.unmapped_weakening", &pose.unmapped_weakening, "", 1, 100,
       "the standard deviations of what such tracks measure count so many times"},

      heading("flow", "Flow: bidirectional pyramidal Lucas-Kanade, and the correspondence filters"),
      {"flow.window", &flow.window, "px", 5, 15, "side of the patch", 2},
      {"flow.levels", &flow.levels, "", 1, 8, "levels of the image pyramid"},
      {"flow.iterations", &flow.iterations, "", 1, 100, "most steps a level"},
      {"flow.damping", &flow.damping, "grey^2/px^2", 0, 1000, "pull towards the predicted position"},
      {"flow.forward_backward", &flow.forward_backward, "px", 0.01, 100,
       "largest error there and back, across the edge"},
      {"flow.least_correlation", &flow.least_correlation, "", -1, 1, "of a patch with its image in the next frame"},
      {"flow.edge_distance", &flow.edge_distance, "px", 0.1, 20, "a point farther from every edge is dropped"},
      {"flow.redundancy", &flow.redundancy, "px", 0, 20, "of two points nearer to each other the younger is dropped"},

      heading("refinement", "Refinement of each point against its keyframe's patch"),
      {"refinement.enabled", &refinement.enabled, "", 0, 0, "off only to measure what it gains"},
      {"refinement.window", &refinement.window, "px", 5, 15, "side of the patch", 2},
      {"refinement.iterations", &refinement.iterations, "", 1, 100, "most steps"},
      {"refinement.damping", &refinement.damping, "grey^2/px^2", 0, 1000, "pull towards the flow's result"},
      {"refinement.least_correlation", &refinement.least_correlation, "", -1, 1, "below it the point is dropped"},
      {"refinement.largest_move", &refinement.largest_move, "px", 0.1, 20,
       "a larger one across the edge is not believed"},

      heading("edge_lock", "Points of straight edges are held at their map point along the edge"),
      {"edge_lock.enabled", &edge_lock.enabled, "", 0, 0, "off only to measure what it gains"},
      {"edge_lock.straightness", &edge_lock.straightness, "", 0, 1,
       "held where the standard deviation across is below this share of that along"},
      {"edge_lock.longest_move", &edge_lock.longest_move, "px", 0, 100, "a longer way is not taken"},

      heading("lines", "Straight edges become lines of the map"),
      {"lines.enabled", &straight_edges.enabled, "", 0, 0, "off only to measure what it gains"},
      {"lines.least_length", &straight_edges.least_length, "px", 10, 10000, "shorter edges are points only"},
      {"lines.least_parallax_deg", &adjustment.lines.least_parallax_deg, "deg", 0.1, 90,
       "largest angle between the planes through a line and two keyframes"},

      heading("camera_finding",
              "What the calibration does not say, or says wrongly, the map tells: how long a rolling shutter reads its "
              "rows, a focal length that is off by 4 % or more, and the distortion of the lens"),
      {"camera_finding.enabled", &settings.mapping.camera_finding.is_enabled, "", 0, 0,
       "off where the calibration is to count as it is"},

      heading("map_reuse", "Map points that come into view again are found and followed on"),
      {"map_reuse.enabled", &reuse.enabled, "", 0, 0, "off only to measure what it gains"},
      {"map_reuse.interval", &reuse.interval, "frames", 1, 1000,
       "from one search to the next; keyframes search besides"},
      {"map_reuse.radius", &reuse.search.radius, "px", 0.5, 50, "searched around the projection"},
      {"map_reuse.least_correlation", &reuse.search.least_correlation, "", -1, 1, "with the keyframe's patch"},
      {"map_reuse.outlier_px", &reuse.outlier_px, "px", 0.1, 100, "farther across its edge a point is not believed"},
      {"map_reuse.latest_keyframes", &view.latest_keyframes, "keyframes", 1, 1000, "whose points are looked for"},
      {"map_reuse.near_keyframes", &view.near_keyframes, "keyframes", 0, 1000,
       "older ones at the same place, likewise"},
      {"map_reuse.largest_turn_deg", &view.largest_turn_deg, "deg", 0, 180, "between these and the latest keyframe"},
      {"map_reuse.largest_distance", &view.largest_distance, "", 0, 100, "to these, as a share of the scene's depth"},

      heading("tracking", "State of tracking"),
      {"tracking.fewest_tracks", &tracking.fewest_tracks, "points", 8, 1000, "fewer do not start a map"},
      {"tracking.restart_share", &tracking.restart_share, "", 0, 1,
       "of the first frame's points: fewer left, a new start"},
      {"tracking.restart_frames", &tracking.restart_frames, "frames", 1, 100, "so many such frames in a row"},
      {"tracking.outlier_frames", &tracking.location.outlier_frames, "frames", 1, 1000,
       "a point that misses the pose so often in a row is dropped"},
      forUsers({"tracking.new_map", &tracking.worlds_enabled, "", 0, 0,
                "a new map is begun beside the old one where the camera stays lost"}),
      forUsers({"tracking.new_map_after_s", &tracking.new_world_seconds, "s", 0.1, 3600,
                "so long after the first sharp frame that was lost"}),
      forUsers(
          {"tracking.predicted_for_s", &tracking.predicted_seconds, "s", 0.1, 3600,
           "with an inertial unit it is begun so long after, and poses are predicted meanwhile; so long in a frozen "
           "map, too"}),
      {"tracking.most_noise", &tracking.noise.most, "", 1, 100,
       "the noise that a camera shows scales what is presumed at most so many times; 1: it is not measured"},
      {"tracking.least_inlier_share", &tracking.location.acceptance.least_inlier_share, "", 0, 1,
       "of the map points followed: fewer agree, and the pose is not believed"},

      heading("orientation_only",
              "Orientation without position: turns on the spot and fast pans, with little of the map in view"),
      {"orientation_only.enabled", &orientation_only.enabled, "", 0, 0,
       "the position is held, with its covariance growing; false: the pose is lost then"},
      {"orientation_only.speed", &orientation_only.speed, "1/s", 0.01, 10,
       "how fast the camera may move meanwhile: distances of the scene"},
      {"orientation_only.least_share", &orientation_only.least_share, "", 0, 1,
       "of what is followed, that must turn with the camera"},
      {"orientation_only.largest_position_deviation", &orientation_only.largest_position_deviation, "", 0.01, 10,
       "share of the scene's distance: less certain, and the pose is lost"},

      heading("keyframes", "Choice of the keyframes (P8 to P12)"),
      {"keyframes.rotation_deg", &keyframes.rotation_deg, "deg", 1, 180, "rotation since the last keyframe ..."},
      {"keyframes.bare_rotation_deg", &keyframes.bare_rotation_deg, "deg", 1, 180,
       "... and where there are few map points, and many tracks on straight edges"},
      {"keyframes.track_share", &keyframes.track_share, "", 0, 1, "correspondences left, of their running average"},
      {"keyframes.fewest_mapped", &keyframes.fewest_mapped, "points", 4, 10000,
       "map points that agree with the pose ..."},
      {"keyframes.mapped_share", &keyframes.mapped_share, "", 0, 1,
       "... or this share of the most there were since the last keyframe"},
      {"keyframes.displacement_share", &keyframes.displacement_share, "", 0, 1,
       "mean displacement since the last keyframe, of the image's width"},
      {"keyframes.interval_s", &keyframes.interval_s, "s", 0.05, 60, "at the latest after this time"},
      {"keyframes.least_interval_s", &keyframes.least_interval_s, "s", 0, 60, "never nearer"},

      heading("initialisation", "Start of the map (P13 to P15)"),
      {"initialisation.frames_between", &initialisation.frames_between, "frames", 0, 50,
       "adjusted with the first and the current one"},
      {"initialisation.attempt_interval", &initialisation.attempt_interval, "frames", 1, 100,
       "from attempt to attempt ..."},
      {"initialisation.fading_share", &initialisation.fading_share, "", 0, 1,
       "... or at each frame, where less of the first frame's points is left"},
      {"initialisation.fewest_frames", &initialisation.fewest_frames, "frames", 1, 100, "after the first one"},
      {"initialisation.least_displacement_px", &initialisation.least_displacement_px, "px", 0, 1000,
       "median motion of the points beyond a rotation ..."},
      {"initialisation.least_displacement_deg", &initialisation.least_displacement_deg, "deg", 0, 90,
       "... or this angle, in a small image that shows many corners, of a run's first map"},
      {"initialisation.least_parallax_deg", &initialisation.least_parallax_deg, "deg", 0.01, 90,
       "median angle between the first and the current camera, seen from the points"},
      {"initialisation.prior_sigma", &initialisation.prior_sigma, "", 0.01, 100,
       "of the inverse depth around its mean"},
      {"initialisation.largest_depth_sigma", &initialisation.largest_depth_sigma, "", 0.01, 10,
       "a point counts where its depth is better known than this share"},
      {"initialisation.fewest_points", &initialisation.fewest_points, "points", 8, 10000, "that must count ..."},
      {"initialisation.point_share", &initialisation.point_share, "", 0, 1, "... or this share of those followed"},
      {"initialisation.five_point_corners", &initialisation.five_point_corners, "points", 8, 10000,
       "corner-like points from which on the five-point start is tried too"},
      {"initialisation.least_quality", &initialisation.least_quality, "", 0, 1,
       "share of the edge pieces that must hold"},
      {"initialisation.early_quality", &initialisation.early_quality, "", 0, 1,
       "the same of a start from fewer frames than from attempt to attempt"},
      {"initialisation.early_points", &initialisation.early_points, "points", 8, 10000,
       "that must count in such a one"},
      {"initialisation.neighbour_px", &quality.neighbour_px, "px", 1, 200, "farthest neighbours in an edge piece ..."},
      {"initialisation.neighbour_deg", &quality.neighbour_deg, "deg", 0.1, 20, "... which in a small image are nearer"},
      {"initialisation.straight_px", &quality.straight_px, "px", 0.1, 20, "a piece is straight within this"},
      {"initialisation.same_depth_ratio", &quality.same_depth_ratio, "", 0, 1,
       "neighbours' depths agree within this share"},
      {"initialisation.straight_depth_ratio", &quality.straight_depth_ratio, "", 0, 1,
       "the middle of a straight piece lies on its chord within this share of the depth"},

      heading("new_points", "New map points (P7, P17)"),
      {"new_points.largest_depth_sigma", &new_points.largest_depth_sigma, "", 0.01, 10,
       "standard deviation over depth"},
      {"new_points.least_parallax_deg", &new_points.least_parallax_deg, "deg", 0.01, 90, "angle between two rays"},
      {"new_points.largest_error", &new_points.largest_error, "sigma", 0.1, 100, "reprojection error in any view"},
      {"new_points.three_view_error", &new_points.three_view_error, "sigma", 0.1, 1000, "of the three-view check"},
      {"new_points.fewest_views", &new_points.fewest_views, "keyframes", 2, 10, "that must see a new point"},

      heading("adjustment", "Local bundle adjustment (P18, P19)"),
      {"adjustment.free_keyframes", &adjustment.free_keyframes, "keyframes", 2, 100, "adjusted around the new one"},
      {"adjustment.fixed_keyframes", &adjustment.fixed_keyframes, "keyframes", 1, 200, "held, to hold the others"},
      {"adjustment.covisible_points", &adjustment.covisible_points, "points", 1, 10000,
       "common points of two covisible keyframes ..."},
      {"adjustment.covisible_share", &adjustment.covisible_share, "", 0, 1, "... or this share of the most there are"},
      {"adjustment.outlier", &adjustment.outlier, "sigma", 0.1, 100, "observations with a larger error are taken out"},
      {"adjustment.largest_depth_sigma", &adjustment.largest_depth_sigma, "", 0.01, 10,
       "points whose depth is known worse than this share are taken out"},

      heading("culling", "Keyframes that add nothing are taken out; the map stays within its bounds"),
      {"culling.enabled", &culling.enabled, "", 0, 0, "off only to measure what it costs"},
      {"culling.recent_keyframes", &culling.recent_keyframes, "keyframes", 3, 1000, "the latest so many stay"},
      {"culling.other_views", &culling.other_views, "keyframes", 1, 100,
       "a point that so many others see does not need a keyframe ..."},
      {"culling.redundant_share", &culling.redundant_share, "", 0.1, 1,
       "... and a keyframe that this share of its points does not need is taken out"},
      forUsers({"culling.most_keyframes", &culling.most_keyframes, "keyframes", 20, 100000, "most that the map keeps"}),
      forUsers(
          {"culling.most_megabytes", &culling.most_megabytes, "MB", 10, 1000000, "most memory that the map takes"}),

      heading("pipeline", "Schedule"),
      {"pipeline.view_delay_frames", &settings.view_delay_frames, "frames", 1, 100,
       "the map that follows from a keyframe is used so many frames later"},

      heading("recovery", "Track-loss recovery (P21) and relocalisation (P22)"),
      {"recovery.enabled", &settings.mapping.recovery_enabled, "", 0, 0, "off only to measure what it gains"},
      {"recovery.fewest_inliers", &settings.mapping.recovery.fewest_inliers, "points", 10, 10000,
       "that must fit three views ..."},
      {"recovery.inlier_share", &settings.mapping.recovery.inlier_share, "", 0, 1, "... or this share of the tracks"},
      {"recovery.relocalisation", &settings.relocalisation_enabled, "", 0, 0, "off only to measure what it gains"},

      heading("loops", "Loop closing (P23 to P27) and adjustment of the whole map (P20)"),
      {"loops.enabled", &settings.loops.enabled, "", 0, 0, "off only to measure what it gains"},
      {"loops.global_interval_keyframes", &settings.places.global_interval_keyframes, "keyframes", 2, 10000,
       "from one adjustment of the whole map to the next ..."},
      {"loops.global_interval_s", &settings.places.global_interval_s, "s", 1, 10000, "... at the latest"},

      heading("bundle", "Solver of the local bundle adjustment"),
      {"bundle.iterations", &bundle.iterations, "", 1, 1000, "most steps"},
      {"bundle.huber", &bundle.huber, "sigma", 0.1, 100, "from here on the error of a measurement counts linearly"},
  };
}

}  // namespace

std::vector<ConfigurationKey> configurationKeys(Configuration& configuration) {
  Keys keys = cameraKeys(configuration.capture);
  for (ConfigurationKey& key : imuKeys(configuration.inertia)) keys.push_back(key);
  for (ConfigurationKey& key : serviceKeys(configuration.service, configuration.settings)) keys.push_back(key);
  for (ConfigurationKey& key : methodKeys(configuration.settings)) keys.push_back(key);
  return keys;
}

bool isOfMethod(const ConfigurationKey& key) {
  constexpr std::array<const char*, 10> others{"camera", "capture",   "imu",   "lcm",    "ros2",
                                               "map",    "recording", "scale", "wheels", "viewer"};
  return std::find(others.begin(), others.end(), key.section()) == others.end();
}

}  // namespace edgeslam
