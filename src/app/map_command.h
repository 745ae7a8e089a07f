// `edgeslam map`: what is in saved maps, several made into one, parts taken out.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

void addMapCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
