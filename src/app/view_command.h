// `edgeslam view`: a recording run at its own pace, shown on a page in the browser.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

void addViewCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
