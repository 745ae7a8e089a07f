#include "benchmark/benchmark_record.h"

#include <filesystem>
#include <set>

#include "benchmark/json_reader.h"
#include "files/atomic_file.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr int record_version = 1;

std::string reportOf(const std::string& folder, const std::string& page_folder) {
  std::error_code error;
  const std::string report = folder + "/report.html";
  return fs::is_regular_file(report, error) ? relativeLink(page_folder, report) : "";
}

// "tests/out/" is called "out".
std::string nameOf(const std::string& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

BenchmarkEntry entryOf(const JsonReader& run) {
  BenchmarkEntry entry;
  entry.name = run.text("name");
  if (entry.name.empty() || entry.name == "." || entry.name == ".." || entry.name.find('/') != std::string::npos ||
      entry.name.find('\0') != std::string::npos) {
    run.fail("name", "the name of a folder beside this file");
  }
  entry.input = run.text("input");
  entry.fingerprint = run.text("fingerprint");
  if (!run.isNull("exit_code")) entry.exit_code = static_cast<int>(std::min<std::int64_t>(run.count("exit_code"), 255));
  entry.message = run.text("message");
  entry.cpu_s = run.number("cpu_s");
  entry.peak_mib = run.number("peak_mib");
  return entry;
}

}  // namespace

void writeBenchmarkRecord(const std::string& folder, const BenchmarkRecord& record) {
  ordered_json runs = ordered_json::array();
  for (const BenchmarkEntry& entry : record.entries) {
    runs.push_back({{"name", entry.name},
                    {"input", entry.input},
                    {"fingerprint", entry.fingerprint},
                    {"exit_code", entry.exit_code < 0 ? ordered_json() : ordered_json(entry.exit_code)},
                    {"message", entry.message},
                    {"cpu_s", entry.cpu_s},
                    {"peak_mib", entry.peak_mib}});
  }
  const ordered_json json = {
      {"version", record_version}, {"source", record.source}, {"jobs", record.jobs}, {"runs", runs}};
  writeFileAtomically(folder + "/" + benchmark_record_name,
                      json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

BenchmarkRecord readBenchmarkRecord(const std::string& folder) {
  const std::string path = folder + "/" + benchmark_record_name;
  const ordered_json json = readJsonObject(path);
  const JsonReader reader(path, json);
  if (reader.count("version") != record_version) reader.fail("version", std::to_string(record_version));
  BenchmarkRecord record;
  record.source = reader.text("source");
  record.jobs = static_cast<int>(std::min<std::int64_t>(reader.count("jobs"), 1000000));
  std::set<std::string> names;
  for (std::size_t i = 0; i < reader.array("runs").size(); ++i) {
    const JsonReader run = reader.element("runs", i);
    record.entries.push_back(entryOf(run));
    if (!names.insert(record.entries.back().name).second) run.fail("name", "a name that no other run has");
  }
  return record;
}

bool isFinished(const std::string& folder, const BenchmarkEntry& entry, const std::string& fingerprint,
                const std::string& program_version, const std::string& configuration) {
  const bool ended = entry.exit_code == 0 || entry.exit_code == 1;
  if (!ended || entry.fingerprint != fingerprint) return false;
  try {
    const RunFigures run = readRunFigures(folder + "/" + entry.name);
    return run.program_version == program_version && run.configuration == configuration && run.input == entry.input;
  } catch (const InputError&) {
    return false;
  }
}

RunSet setOfBenchmark(const std::string& folder, const BenchmarkRecord& record, const std::string& page_folder) {
  RunSet set;
  set.title = nameOf(record.source.empty() ? folder : record.source);
  set.note = "Sequences under " + record.source;
  set.jobs = record.jobs;
  for (const BenchmarkEntry& entry : record.entries) {
    const std::string run_folder = folder + "/" + entry.name;
    SetRun run;
    run.name = entry.name;
    run.input = entry.input;
    run.failed = entry.exit_code != 0;
    run.message = entry.message;
    if (entry.exit_code == 0 || entry.exit_code == 1) {
      try {
        run.figures = readRunFigures(run_folder);
        run.link = reportOf(run_folder, page_folder);
        run.cpu_s = entry.cpu_s, run.peak_mib = entry.peak_mib;
      } catch (const InputError& problem) {
        run.failed = true;
        if (run.message.empty()) run.message = problem.what();
      }
    }
    set.runs.push_back(run);
  }
  return set;
}

RunSet setOfRuns(const std::vector<std::string>& folders, const std::string& page_folder) {
  RunSet set;
  set.title = std::to_string(folders.size()) + " runs";
  for (const std::string& folder : folders) {
    SetRun run;
    run.figures = readRunFigures(folder);
    run.name = nameOf(folder);
    if (run.name != run.figures->sequence) run.name += " (" + run.figures->sequence + ")";
    run.input = run.figures->input;
    run.link = reportOf(folder, page_folder);
    run.failed = run.figures->with_pose == 0;
    if (run.failed) run.message = "no frame has a pose";
    set.runs.push_back(run);
  }
  return set;
}

}  // namespace edgeslam
