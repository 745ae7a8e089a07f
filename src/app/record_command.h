// `edgeslam record`: frames of a live camera as a folder in TUM layout, which replay and others' tools read.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

// Adds the subcommand; `exit_code` and `app` must outlive the parsing.
void addRecordCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
