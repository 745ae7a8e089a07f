#include "app/calibrate_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "app/calibration_frames.h"
#include "app/command_line.h"
#include "app/end_signals.h"
#include "app/inertial_command.h"
#include "app/output_file.h"
#include "app/readout_command.h"
#include "calibration/board_pdf.h"
#include "calibration/calibration.h"
#include "calibration/calibration_text.h"
#include "calibration/coverage.h"
#include "configuration/configuration.h"
#include "drivers/cameras/open_camera.h"
#include "files/atomic_file.h"

namespace edgeslam {
namespace {

struct CalibrateOptions {
  std::string input, camera, configuration, board, output = "camera.yaml", model = "auto";
  double seconds = 0;
  bool force = false;
  bool readout = false;
  bool imu = false;
};

struct BoardOptions {
  std::string type = "chessboard", square, marker, paper = "A4", markers = "5x5", output;
  int columns = 0, rows = 0;
  double spacing = 0.3;
  bool force = false;
};

std::string countsText(const SelectionCounts& counts, std::size_t views) {
  std::string text = std::to_string(counts.frames) + " frames, " + std::to_string(counts.looked_at) + " looked at, " +
                     std::to_string(views) + " taken";
  const auto append = [&text](std::int64_t count, const char* what) {
    if (count > 0) text += ", " + std::to_string(count) + " " + what;
  };
  append(counts.no_board, "without the board");
  append(counts.blurred, "not sharp");
  append(counts.moving, "with the board moving");
  append(counts.not_new, "like others");
  return text;
}

// A board other than the one given is the likeliest reason for finding none.
void checkBoardWasSeen(const ViewSelection& selection, const Board& board) {
  if (selection.counts().frames == 0) throw InputError("there is no frame to calibrate from");
  const SelectionCounts& counts = selection.counts();
  if (!selection.views().empty() && 2 * counts.no_board < counts.looked_at) return;
  if (selection.lastWithoutBoard().empty()) return;
  const std::string other = otherBoardSeen(selection.lastWithoutBoard(), board);
  if (!other.empty()) throw InputError("the board " + boardText(board) + " is not found; there is " + other);
  if (selection.views().empty()) {
    throw InputError("the board " + boardText(board) + " is found in none of " + std::to_string(counts.looked_at) +
                     " frames" + (counts.blurred > 0 ? " sharply enough" : "") +
                     "; a chessboard must be seen whole, with a white border");
  }
}

CalibrationOptions calibrationOptions(const CalibrateOptions& options) {
  CalibrationOptions chosen;
  if (options.model == "pinhole_radial_tangential") chosen.model = CameraModel::pinhole_radial_tangential;
  if (options.model == "kannala_brandt") chosen.model = CameraModel::kannala_brandt;
  return chosen;
}

// Returns what the frames came from.
std::string takeViewsFrom(const CalibrateOptions& options, const Board& board, ViewSelection& selection) {
  const TellLine tell = [](const std::string& line) { std::cerr << line << std::endl; };
  if (!options.input.empty()) {
    const std::unique_ptr<FrameSource> source = openStillsOrFrames(options.input);
    tell(options.input + ": " + source->kind() +
         (source->size() > 0 ? ", " + std::to_string(source->size()) + " frames" : ""));
    takeViews(*source, board, selection, tell);
    return options.input;
  }
  CameraOptions capture;
  if (!options.configuration.empty()) capture = readConfiguration(options.configuration).capture;
  if (!options.camera.empty()) capture.device = options.camera;
  const std::unique_ptr<ReopeningCamera> camera = openLastingCamera(capture);
  const StreamDescription stream = camera->stream();
  EndSignals signals;
  tell("calibrating " + stream.camera + ", " + stream.format + ", with " + boardText(board) +
       " (Ctrl-C: with what is there)");
  takeViews(
      *camera, board, options.seconds, selection, [&] { return signals.came(); }, tell);
  return stream.camera + ", " + stream.format;
}

int calibrateCamera(const CalibrateOptions& options) {
  const Board board = parseBoard(options.board);
  refuseToReplace(options.output, options.force);
  ViewSelection selection(board, {});
  const std::string source = takeViewsFrom(options, board, selection);
  std::cerr << countsText(selection.counts(), selection.views().size()) << std::endl;
  checkBoardWasSeen(selection, board);
  const Calibration calibration =
      calibrate(selection.views(), board, selection.imageSize(), calibrationOptions(options));
  writeFileAtomically(options.output, calibrationFileText(calibration, board, source));
  const ViewCoverage coverage = coverageOf(selection.views(), selection.imageSize());
  std::cout << options.output << ": " << calibrationSummary(calibration, coverage);
  for (const std::string& wish : missingViews(coverage)) std::cout << "  it would gain from: " << wish << "\n";
  return exit_done;
}

Board boardOf(const BoardOptions& options) {
  std::string text =
      options.type + ":" + std::to_string(options.columns) + "x" + std::to_string(options.rows) + ":" + options.square;
  if (options.type == "charuco") {
    const double square_m = parseLength(options.square, "--square");
    text += ":" + (options.marker.empty() ? lengthText(0.75 * square_m) : options.marker) + ":" + options.markers;
  }
  if (options.type == "aprilgrid") text += ":" + std::to_string(options.spacing);
  return parseBoard(text);
}

int printBoard(const BoardOptions& options) {
  const Board board = boardOf(options);
  const std::string pdf = boardPdf(board, paperOfName(options.paper));
  refuseToReplace(options.output, options.force);
  writeFileAtomically(options.output, pdf);
  std::cout << options.output << ": " << boardSizeText(board) << " on " << options.paper
            << "; print at 100 %, measure the ruler, then: edgeslam calibrate INPUT --board " << boardText(board)
            << "\n";
  return exit_done;
}

void addBoardCommand(CLI::App& calibrate_command, int& exit_code) {
  const auto options = std::make_shared<BoardOptions>();
  CLI::App* command = calibrate_command.add_subcommand("board", "Write a board to print, as PDF");
  command->add_option("--type", options->type, "chessboard, charuco or aprilgrid")
      ->capture_default_str()
      ->check(CLI::IsMember({"chessboard", "charuco", "aprilgrid"}));
  command
      ->add_option("--columns", options->columns, "Inner corners (chessboard), squares (charuco) or tags (aprilgrid)")
      ->required();
  command->add_option("--rows", options->rows, "Inner corners, squares or tags from top to bottom")->required();
  command->add_option("--square", options->square, "Side of a square, or of a tag, with its unit: 30mm")->required();
  command->add_option("--marker", options->marker, "charuco: side of the markers; 0.75 of the square by default");
  command->add_option("--markers", options->markers, "charuco: cells of the ArUco markers, 4x4, 5x5, 6x6 or 7x7")
      ->capture_default_str();
  command->add_option("--spacing", options->spacing, "aprilgrid: gap between tags over a tag's side")
      ->capture_default_str();
  command->add_option("--paper", options->paper, "A0 to A5, letter, legal, tabloid, or WIDTHxHEIGHT [mm]")
      ->capture_default_str();
  command->add_option("--output", options->output, "PDF file to write")->required();
  command->add_flag("--force", options->force, "Replace the file");
  command->callback([options, &exit_code] { exit_code = printBoard(*options); });
}

}  // namespace

void addCalibrateCommand(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      app.add_subcommand("calibrate",
                         "Calibrate a camera with a printed board, which `calibrate board` makes, or find its "
                         "readout or inertial unit");
  CLI::Option* input =
      command->add_option("INPUT", options->input, "Recording, video, or folder of images; not given: the live camera");
  CLI::Option* camera = command->add_option("--camera", options->camera, "Live camera, as `edgeslam cameras` names it");
  command->add_option("--config", options->configuration,
                      "Configuration (YAML) whose capture section names the camera");
  input->excludes(camera);
  command->add_option("--board", options->board,
                      "The board: chessboard:9x6:30mm, charuco:8x6:30mm:22mm or aprilgrid:6x6:25mm:0.3");
  command->add_option("--model", options->model, "pinhole_radial_tangential, kannala_brandt (fisheye), or auto")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "pinhole_radial_tangential", "kannala_brandt"}));
  command->add_option("--seconds", options->seconds, "End the live camera after this time [s]")
      ->check(CLI::Range(0.001, 1e9));
  command->add_option("--output", options->output, "Calibration to write (YAML)")->capture_default_str();
  command->add_flag("--force", options->force, "Replace the file");
  CLI::Option* readout = command->add_flag(
      "--readout", options->readout,
      "Find the readout of a rolling shutter instead, from a recording (INPUT) of a calibrated camera that moves");
  readout->excludes(camera);
  CLI::Option* imu = command->add_flag(
      "--imu", options->imu,
      "Find how the inertial unit sits on the camera instead, and how their clocks differ, from a recording (INPUT) of "
      "a calibrated camera that turns about all axes, in any scene or before a --board; --output is its imu.yaml");
  imu->excludes(camera)->excludes(readout);
  command->require_subcommand(0, 1);
  addBoardCommand(*command, exit_code);
  command->callback([options, command, &exit_code] {
    if (!command->get_subcommands().empty()) return;
    if (options->readout) {
      if (options->input.empty()) throw CLI::RequiredError("INPUT");
      exit_code = findReadout(options->input, options->configuration);
      return;
    }
    if (options->imu) {
      if (options->input.empty()) throw CLI::RequiredError("INPUT");
      const std::string unit_file = command->count("--output") > 0 ? options->output : "";
      exit_code = calibrateUnit({options->input, options->configuration, options->board, unit_file, options->force});
      return;
    }
    if (options->board.empty()) throw CLI::RequiredError("--board");
    if (!options->input.empty() && !options->configuration.empty()) {
      throw CLI::ExcludesError("INPUT", "--config");
    }
    if (options->input.empty() && options->camera.empty() && options->configuration.empty()) {
      throw CLI::RequiredError("INPUT, --camera or --config");
    }
    exit_code = calibrateCamera(*options);
  });
}

}  // namespace edgeslam
