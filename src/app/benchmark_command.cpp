#include "app/benchmark_command.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>

#include "app/command_line.h"
#include "benchmark/benchmark_record.h"
#include "benchmark/benchmark_run.h"
#include "benchmark/known_calibration.h"
#include "benchmark/slurm_array.h"
#include "configuration/configuration.h"
#include "configuration/configuration_text.h"
#include "files/atomic_file.h"
#include "frames/frame_source.h"
#include "recording/recording_layout.h"
#include "recording/recording_source.h"
#include "report/report.h"
#include "service/daemon_signals.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

struct BenchmarkArguments {
  std::string folder;
  std::string output = "benchmark";
  std::string configuration;
  std::vector<std::string> only;
  int jobs = 0;  // 0: as many as cores are allowed
  bool again = false;
  std::string slurm;                       // empty: on this machine
  std::vector<std::string> slurm_options;  // for sbatch
  std::string slurm_task;
};

int coresAllowed() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return sched_getaffinity(0, sizeof(cores), &cores) == 0 ? std::max(1, CPU_COUNT(&cores)) : 1;
}

// Rewritten in place on a terminal; elsewhere only when a run has ended.
class ProgressLine {
 public:
  ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const BenchmarkProgress& progress) {
    const bool changed = progress.done != shown_done_;
    if (!terminal_ && !changed) return;
    shown_done_ = progress.done;
    std::cerr << (terminal_ ? "\r\033[K" : "") << formatProgress(progress) << (terminal_ ? "" : "\n") << std::flush;
  }
  void clear() const {
    if (terminal_) std::cerr << "\r\033[K" << std::flush;
  }

 private:
  bool terminal_;
  std::size_t shown_done_ = 0;
};

// What replay will take: the file given, or a recording's own, or the defaults.
Configuration configurationFor(const BenchmarkArguments& arguments, const FoundSequence& sequence) {
  if (!arguments.configuration.empty()) return readConfiguration(arguments.configuration);
  if (isRecording(sequence.folder)) return readConfiguration(sequence.folder + "/" + recording_configuration_name);
  return {};
}

// A sequence without a calibration that we know by name gets a configuration with it, in the run's folder.
PlannedRun planned(const BenchmarkArguments& arguments, const FoundSequence& sequence, const std::string& output,
                   const BenchmarkRecord& before) {
  PlannedRun run;
  run.sequence = sequence;
  run.fingerprint = sequenceFingerprint(sequence.folder);
  if (!arguments.configuration.empty()) run.configuration_path = fs::absolute(arguments.configuration).string();
  if (!sequence.problem.empty()) return run;  // replay tells it
  Configuration configuration = configurationFor(arguments, sequence);
  if (!configuration.camera && !sequence.has_calibration) configuration.camera = knownCalibration(sequence.folder);
  const std::string text = formatConfiguration(configuration);
  if (configuration.camera && !sequence.has_calibration) {
    const std::string folder = output + "/" + sequence.name;
    fs::create_directories(folder);
    run.configuration_path = folder + "/configuration.yaml";
    writeFileAtomically(run.configuration_path, text);
  }
  const auto entry = std::find_if(before.entries.begin(), before.entries.end(),
                                  [&](const BenchmarkEntry& known) { return known.name == sequence.name; });
  run.is_finished = !arguments.again && entry != before.entries.end() && entry->input == sequence.folder &&
                    isFinished(output, *entry, run.fingerprint, EDGESLAM_VERSION, text);
  return run;
}

std::vector<FoundSequence> chosen(const SequenceSearch& search, const BenchmarkArguments& arguments) {
  if (search.sequences.empty()) {
    throw InputError(arguments.folder +
                     ": no sequence found; expected TUM RGB-D, ICL-NUIM or EuRoC folders, recordings, "
                     "or folders with a video or images and a camera.yaml");
  }
  if (arguments.only.empty()) return search.sequences;
  std::vector<FoundSequence> sequences;
  for (const std::string& name : arguments.only) {
    const auto found = std::find_if(search.sequences.begin(), search.sequences.end(),
                                    [&](const FoundSequence& sequence) { return sequence.name == name; });
    if (found == search.sequences.end()) {
      std::string names;
      for (const FoundSequence& sequence : search.sequences) names += (names.empty() ? "" : ", ") + sequence.name;
      throw InputError("--only: no sequence is called " + name + "; there are " + names);
    }
    sequences.push_back(*found);
  }
  return sequences;
}

// What is there already; nothing of it counts where it cannot be read.
BenchmarkRecord recordBefore(const std::string& output) {
  std::error_code error;
  if (!fs::exists(output + "/" + benchmark_record_name, error)) return {};
  try {
    return readBenchmarkRecord(output);
  } catch (const InputError& problem) {
    std::cerr << "edgeslam: " << problem.what() << "; all is run again\n";
    return {};
  }
}

void makeOutput(const std::string& output) {
  std::error_code error;
  fs::create_directories(output, error);
  if (error) throw InputError(output + ": cannot be made a folder for the results: " + error.message());
}

BenchmarkPlan planOf(const BenchmarkArguments& arguments, const std::string& output, const BenchmarkRecord& before) {
  const SequenceSearch search = findSequences(arguments.folder, output);
  for (const std::string& note : search.notes) std::cerr << "edgeslam: " << note << "\n";
  BenchmarkPlan plan;
  plan.program = fs::read_symlink("/proc/self/exe").string();
  plan.output = output;
  plan.jobs = arguments.jobs > 0 ? arguments.jobs : coresAllowed();
  std::set<std::string> names;
  for (const FoundSequence& sequence : chosen(search, arguments)) {
    if (names.insert(sequence.name).second) plan.runs.push_back(planned(arguments, sequence, output, before));
  }
  if (!arguments.slurm.empty() && arguments.jobs == 0) plan.jobs = static_cast<int>(plan.runs.size());
  return plan;
}

void tellPlan(const BenchmarkPlan& plan) {
  const auto finished =
      std::count_if(plan.runs.begin(), plan.runs.end(), [](const PlannedRun& run) { return run.is_finished; });
  std::cerr << plan.runs.size() << " sequences, " << plan.jobs << " at once";
  if (finished > 0) {
    std::cerr << "; " << finished << " finished before with the same version, configuration and input: not run again "
              << "(--again does)";
  }
  std::cerr << "\n";
}

// Runs that were planned, and earlier ones whose sequences are still there, by name.
void bringUpToDate(BenchmarkRecord& record, const BenchmarkArguments& arguments, const BenchmarkPlan& plan) {
  record.source = fs::canonical(arguments.folder).string();
  record.jobs = plan.jobs;
  std::error_code error;
  const auto is_gone = [&](const BenchmarkEntry& entry) { return !fs::exists(entry.input, error); };
  record.entries.erase(std::remove_if(record.entries.begin(), record.entries.end(), is_gone), record.entries.end());
}

// Ended as any other where it was: Slurm shows it then as failed.
int runTask(const BenchmarkArguments& arguments) {
  DaemonSignals signals;
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  return runSlurmTask(program, arguments.slurm_task, [&signals] { return signals.end(); }) ? exit_done : exit_failed;
}

// Slurm is handed all runs at once; it has its own mind about how many go on.
bool runOnSlurm(const BenchmarkArguments& arguments, BenchmarkPlan plan, BenchmarkRecord& record,
                const BenchmarkListener& listener) {
  SlurmSettings settings;
  settings.program = plan.program, settings.output = plan.output;
  settings.source = fs::canonical(arguments.folder).string();
  settings.options = arguments.slurm_options;
  settings.at_once = arguments.jobs;
  plan.jobs = static_cast<int>(plan.runs.size());
  SlurmArray array(settings);
  const bool all_were_run = runBenchmark(plan, record, listener, array);
  if (all_were_run || array.job().empty()) return all_were_run;
  const bool is_cancelled = array.cancel();
  std::cerr << "\nedgeslam: Slurm's job " << array.job()
            << (is_cancelled ? " is cancelled\n" : " could not be cancelled; see `squeue`\n");
  return false;
}

int runBenchmarkCommand(const BenchmarkArguments& arguments) {
  if (!arguments.slurm_task.empty()) return runTask(arguments);
  DaemonSignals signals;  // before any thread or child
  makeOutput(arguments.output);
  const std::string output = fs::canonical(arguments.output).string();
  BenchmarkRecord record = recordBefore(output);
  const BenchmarkPlan plan = planOf(arguments, output, record);
  bringUpToDate(record, arguments, plan);
  tellPlan(plan);

  ProgressLine line;
  BenchmarkListener listener;
  listener.stop = [&signals] { return signals.end(); };
  listener.going = [&line](const BenchmarkProgress& progress) { line.show(progress); };
  listener.ended = [&line](const PlannedRun& run, const BenchmarkEntry& entry) {
    line.clear();
    if (entry.exit_code != 0) std::cerr << "edgeslam: " << run.sequence.name << " failed: " << entry.message << "\n";
  };
  const bool all_were_run =
      arguments.slurm.empty() ? runBenchmark(plan, record, listener) : runOnSlurm(arguments, plan, record, listener);
  line.clear();

  std::sort(record.entries.begin(), record.entries.end(),
            [](const BenchmarkEntry& a, const BenchmarkEntry& b) { return a.name < b.name; });
  writeBenchmarkRecord(output, record);
  const RunSet set = setOfBenchmark(output, record, output);
  std::cout << formatSetTable(set);
  if (reportsAreBuiltIn()) {
    writeFileAtomically(output + "/index.html", formatSetPage(set));
    std::cout << arguments.output << "/index.html shows it all\n";
  }
  if (!all_were_run) std::cerr << "edgeslam: stopped; the same command goes on from here\n";
  const bool any_failed = std::any_of(plan.runs.begin(), plan.runs.end(), [&](const PlannedRun& run) {
    return std::any_of(set.runs.begin(), set.runs.end(),
                       [&](const SetRun& shown) { return shown.name == run.sequence.name && shown.failed; });
  });
  return any_failed ? exit_failed : exit_done;
}

// Options that are not ours are sbatch's where it is Slurm that runs.
void takeSlurmOptions(const CLI::App& command, BenchmarkArguments& arguments) {
  std::vector<std::string> others = command.remaining();
  if (arguments.slurm.empty() && !others.empty()) throw CLI::ExtrasError(command.get_name(), others);
  constexpr const char* plain_flag = "true";
  if (arguments.slurm != plain_flag) others.insert(others.begin(), arguments.slurm);
  for (const std::string& text : others) {
    for (const std::string& word : slurmOptions(text)) arguments.slurm_options.push_back(word);
  }
}

}  // namespace

void addBenchmarkCommand(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<BenchmarkArguments>();
  CLI::App* command = app.add_subcommand("benchmark",
                                         "Run over all sequences under a folder, several at once, and make one page of "
                                         "them; continues where it was stopped");
  command
      ->add_option(
          "DIR", arguments->folder,
          "Folder with TUM RGB-D, ICL-NUIM or EuRoC folders, recordings, or folders with a video or images and "
          "a camera.yaml, at most 6 folders deep")
      ->required();
  command->add_option("--output", arguments->output, "Folder for the results, one folder a sequence, and index.html")
      ->capture_default_str();
  command->add_option("--jobs", arguments->jobs, "Runs at once (default: the number of cores allowed)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--config", arguments->configuration,
                      "Configuration file (YAML) of all runs; without it the defaults");
  command->add_option("--only", arguments->only, "Names of the sequences to run, separated by commas")->delimiter(',');
  command->add_flag("--again", arguments->again, "Also repeat the runs that are finished");
  command->add_flag("--slurm", arguments->slurm,
                    "Run them on a cluster, as one job array of Slurm. Options for sbatch may follow, as in "
                    "--slurm=\"--partition=fast --time=1:00:00\"; --output is to be a folder that all nodes share");
  command->add_option("--slurm-task", arguments->slurm_task, "One task of the array, which --slurm starts on a node")
      ->group("");
  command->allow_extras();  // sbatch's
  command->callback([arguments, command, &exit_code] {
    takeSlurmOptions(*command, *arguments);
    exit_code = runBenchmarkCommand(*arguments);
  });
}

}  // namespace edgeslam
