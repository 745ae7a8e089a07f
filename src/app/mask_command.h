// `edgeslam mask`: proposes the camera's mask from a recording, as an image to look at.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

void addMaskCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
