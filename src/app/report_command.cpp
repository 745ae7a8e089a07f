#include "app/report_command.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "app/command_line.h"
#include "benchmark/benchmark_record.h"
#include "benchmark/comparison.h"
#include "files/atomic_file.h"
#include "report/report.h"

namespace edgeslam {
namespace {

struct ReportArguments {
  std::vector<std::string> runs;
  std::string output = "runs.html";
};

bool isBenchmark(const std::string& folder) {
  std::error_code error;
  return std::filesystem::exists(folder + "/" + benchmark_record_name, error);
}

std::string pageOf(const ReportArguments& arguments) {
  const std::string page_folder = std::filesystem::path(arguments.output).parent_path().string();
  if (arguments.runs.size() == 1) {
    const std::string& folder = arguments.runs.front();
    if (!isBenchmark(folder)) {
      throw InputError(folder +
                       ": expected a folder that `edgeslam benchmark` made; of single runs give two or more, "
                       "each has its own report.html already");
    }
    return formatSetPage(setOfBenchmark(folder, readBenchmarkRecord(folder), page_folder));
  }
  if (arguments.runs.size() == 2) {
    return formatComparison(readComparedRun(arguments.runs[0]), readComparedRun(arguments.runs[1]));
  }
  return formatSetPage(setOfRuns(arguments.runs, page_folder));
}

int runReport(const ReportArguments& arguments) {
  if (!reportsAreBuiltIn()) throw InputError("this build makes no pages (EDGESLAM_REPORTS=OFF)");
  writeFileAtomically(arguments.output, pageOf(arguments));
  std::cout << arguments.output << " shows it all\n";
  return exit_done;
}

}  // namespace

void addReportCommand(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand(
      "report", "A page of two runs side by side, or of a set of runs, to look at in a browser without a network");
  command
      ->add_option("RUN", arguments->runs,
                   "Folders that `edgeslam replay` wrote: two are set side by side, three or more make a table; or one "
                   "folder that `edgeslam benchmark` wrote")
      ->required();
  command->add_option("--output", arguments->output, "The page")->type_name("FILE.html")->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = runReport(*arguments); });
}

}  // namespace edgeslam
