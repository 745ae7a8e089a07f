#include "benchmark/slurm_array.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>

#include "benchmark/json_reader.h"
#include "edgeslam/input_error.h"
#include "files/atomic_file.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t longest_answer = std::size_t{16} << 20U;  // [bytes]
constexpr double ask_interval_s = 5, look_interval_s = 0.5;
// A shared folder may show a file some seconds after it was written on a node.
constexpr double late_files_s = 10;

std::string programInPath(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/" + name;
    if (!folder.empty() && access(program.c_str(), X_OK) == 0 && fs::is_regular_file(program)) return program;
  }
  throw InputError("--slurm: " + name + " is not in the PATH; expected Slurm's commands (Debian: slurm-client)");
}

std::string contentOrNothing(const std::string& path) {
  try {
    return readBoundedFile(path, longest_answer);
  } catch (const InputError&) {
    return "";
  }
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

// As a word of the shell.
std::string shellWord(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// "12" or "12;cluster"; empty where the line is something else.
std::string jobIn(const std::string& line) {
  const std::size_t digits = std::min(line.find_first_not_of("0123456789"), line.size());
  return digits > 0 && (digits == line.size() || line[digits] == ';') ? line.substr(0, digits) : "";
}

bool hasEnded(const std::string& state) {
  constexpr std::array<const char*, 8> going = {"PENDING", "RUNNING",   "CONFIGURING",  "COMPLETING",
                                                "STOPPED", "SUSPENDED", "REQUEUE_HOLD", "REQUEUED"};
  return std::find(going.begin(), going.end(), state) == going.end();
}

}  // namespace

std::vector<std::string> slurmOptions(const std::string& text) {
  std::vector<std::string> words;
  char quote = 0;
  bool in_word = false;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\t' || c == '\n';
    if (quote == 0 && is_blank) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    } else {
      words.back() += c;
    }
  }
  if (quote != 0) throw InputError("--slurm: a quote is not closed in: " + text);
  return words;
}

SlurmArray::SlurmArray(const SlurmSettings& settings) : settings_(settings) {
  for (const std::string& option : settings.options) {
    if (option.rfind("--array", 0) == 0 || option.rfind("-a", 0) == 0) {
      throw InputError("--slurm: " + option + " cannot be given: the array is of the sequences; --jobs limits it");
    }
  }
}

SlurmArray::~SlurmArray() {
  try {
    cancel();
    if (!folder_.empty()) fs::remove_all(folder_);
  } catch (const std::exception&) {  // what is left there does no harm
  }
}

std::string SlurmArray::path(int index, const std::string& ending) const {
  return folder_ + "/" + std::to_string(index) + ending;
}

void SlurmArray::start(std::size_t number, const std::vector<std::string>& command, const std::string& log_path) {
  if (!job_.empty()) throw std::logic_error("an array that was handed over takes no more tasks");
  if (folder_.empty()) {
    sbatch_ = programInPath("sbatch"), squeue_ = programInPath("squeue"), scancel_ = programInPath("scancel");
    std::string pattern = settings_.output + "/slurm-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) throw InputError(pattern + ": cannot be made: " + std::strerror(errno));
    folder_ = pattern;
  }
  const int index = started_++;
  const ordered_json task = {{"arguments", std::vector<std::string>(command.begin() + 1, command.end())},
                             {"log", log_path}};
  writeFileAtomically(path(index, ".json"), task.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  Task added;
  added.number = number;
  tasks_[index] = added;
}

bool SlurmArray::isUnderWay(std::size_t number) const {
  return std::any_of(tasks_.begin(), tasks_.end(), [&](const auto& task) {
    return task.second.number == number && files_.count(std::to_string(task.first) + ".started") > 0;
  });
}

void SlurmArray::submit() {
  const std::string script = folder_ + "/task.sh", said = folder_ + "/sbatch.log";
  writeFileAtomically(script, "#!/bin/sh\nexec " + shellWord(settings_.program) + " benchmark " +
                                  shellWord(settings_.source) + " --output " + shellWord(settings_.output) +
                                  " --slurm-task " + shellWord(folder_) + "/\"$SLURM_ARRAY_TASK_ID\".json\n");
  std::string array = "--array=0-" + std::to_string(started_ - 1);
  if (settings_.at_once > 0) array += "%" + std::to_string(settings_.at_once);
  std::vector<std::string> command{sbatch_,      "--parsable",         "--job-name=edgeslam",
                                   "--ntasks=1", "--chdir=" + folder_, "--output=" + folder_ + "/%a.log"};
  command.insert(command.end(), settings_.options.begin(), settings_.options.end());
  command.push_back(array);
  command.push_back(script);
  ChildProcesses children;
  children.start(0, command, said);
  constexpr double patience_s = 120;
  const std::optional<RunEnd> end = children.waitForOne(patience_s);
  if (!end) throw InputError("--slurm: sbatch does not answer");
  const std::vector<std::string> lines = linesOf(contentOrNothing(said));
  for (const std::string& line : lines) {
    if (job_.empty()) job_ = jobIn(line);
  }
  if (end->exit_code != 0 || job_.empty()) {
    job_.clear();
    throw InputError("--slurm: sbatch refuses: " + (lines.empty() ? "it says nothing" : lines.front()));
  }
}

// Throws where what is there is no result of a task.
static RunEnd resultIn(const std::string& path) {
  const ordered_json json = readJsonObject(path);
  const JsonReader reader(path, json);
  RunEnd end;
  if (!reader.isNull("exit_code"))
    end.exit_code = static_cast<int>(std::min<std::int64_t>(reader.count("exit_code"), 255));
  end.signal = static_cast<int>(std::min<std::int64_t>(reader.count("signal"), 64));
  end.wall_s = reader.number("wall_s"), end.cpu_s = reader.number("cpu_s"), end.peak_mib = reader.number("peak_mib");
  return end;
}

std::optional<RunEnd> SlurmArray::takeEnded() {
  if (now_s() - looked_s_ >= look_interval_s) {
    files_.clear();
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error))
      files_.insert(entry.path().filename().string());
    looked_s_ = now_s();
  }
  for (const auto& [index, task] : tasks_) {
    RunEnd end;
    if (files_.count(std::to_string(index) + ".result") > 0) {
      try {
        end = resultIn(path(index, ".result"));
      } catch (const InputError& problem) {
        end.problem = problem.what();
      }
    } else if (task.gone_since_s >= 0 && now_s() - task.gone_since_s >= late_files_s) {
      end = endWithoutResult(index, task);
    } else {
      continue;
    }
    end.number = task.number;
    tasks_.erase(index);
    return end;
  }
  return std::nullopt;
}

RunEnd SlurmArray::endWithoutResult(int index, const Task& task) const {
  const bool left_anything =
      files_.count(std::to_string(index) + ".log") + files_.count(std::to_string(index) + ".started") > 0;
  if (!left_anything && (task.state == "FAILED" || task.state == "COMPLETED")) {
    throw InputError(settings_.output + ": the node of job " + job_ + "_" + std::to_string(index) +
                     " does not see it; expected a folder that all nodes share, for --output");
  }
  const std::vector<std::string> lines = linesOf(contentOrNothing(path(index, ".log")));
  RunEnd end;
  end.problem =
      "Slurm ended job " + job_ + "_" + std::to_string(index) + (task.state.empty() ? "" : " (" + task.state + ")");
  if (!lines.empty()) end.problem += ": " + lines.back();
  return end;
}

// squeue may take its time; it is not waited for.
void SlurmArray::askForStates() {
  const std::string said = folder_ + "/squeue.log";
  if (const std::optional<RunEnd> end = asking_.waitForOne(0)) noteStates(contentOrNothing(said), end->exit_code == 0);
  if (asking_.running() > 0 || now_s() - asked_s_ < ask_interval_s) return;
  asking_.start(0, {squeue_, "--noheader", "--array", "--states=all", "--jobs=" + job_, "--format=%K %T"}, said);
  asked_s_ = now_s();
}

// A controller that does not answer is no end of a task; one that has forgotten the job is.
void SlurmArray::noteStates(const std::string& answer, bool is_known) {
  const bool is_forgotten = !is_known && answer.find("Invalid job id") != std::string::npos;
  if (!is_known && !is_forgotten) return;
  std::set<int> going;
  for (const std::string& line : linesOf(answer)) {
    std::istringstream words(line);
    int index = 0;
    std::string state;
    if (!(words >> index >> state)) continue;
    const auto task = tasks_.find(index);
    if (task == tasks_.end()) continue;
    task->second.state = state;
    if (!hasEnded(state)) going.insert(index);
  }
  for (auto& [index, task] : tasks_) {
    if (going.count(index) > 0) {
      task.gone_since_s = -1;
    } else if (task.gone_since_s < 0) {
      task.gone_since_s = now_s();
      // One that is cancelled while it waits leaves the queue without a last state.
      if (task.state.empty() || !hasEnded(task.state)) task.state = "gone from the queue";
    }
  }
}

std::optional<RunEnd> SlurmArray::waitForOne(double patience_s) {
  if (tasks_.empty()) return std::nullopt;
  if (job_.empty()) submit();
  const double until_s = now_s() + patience_s;
  while (true) {
    askForStates();
    std::optional<RunEnd> end = takeEnded();
    if (end || now_s() >= until_s) return end;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

bool SlurmArray::cancel() {
  if (job_.empty() || tasks_.empty()) return false;
  constexpr double patience_s = 30;
  ChildProcesses children;
  children.start(0, {scancel_, job_}, folder_ + "/scancel.log");
  const std::optional<RunEnd> end = children.waitForOne(patience_s);
  tasks_.clear();
  return end && end->exit_code == 0;
}

bool runSlurmTask(const std::string& program, const std::string& task_path, const std::function<bool()>& stop) {
  const ordered_json json = readJsonObject(task_path);
  const JsonReader task(task_path, json);
  std::vector<std::string> command{program};
  for (const ordered_json& argument : task.array("arguments")) {
    if (!argument.is_string()) task.fail("arguments", "words");
    command.push_back(argument.get<std::string>());
  }
  if (command.size() < 2 || command[1] != "replay") task.fail("arguments", "those of `edgeslam replay`");
  const std::string stem = task_path.substr(0, task_path.rfind(".json"));
  writeFileAtomically(stem + ".started", "");
  ChildProcesses children;
  children.start(0, command, task.text("log"));
  constexpr double patience_s = 0.1;
  std::optional<RunEnd> end;
  while (!end) {
    if (stop()) return false;
    end = children.waitForOne(patience_s);
  }
  const ordered_json result = {{"exit_code", end->exit_code < 0 ? ordered_json() : ordered_json(end->exit_code)},
                               {"signal", end->signal},
                               {"wall_s", end->wall_s},
                               {"cpu_s", end->cpu_s},
                               {"peak_mib", end->peak_mib}};
  writeFileAtomically(stem + ".result", result.dump() + "\n");
  return true;
}

}  // namespace edgeslam
