// Runs a fuzz target without a fuzzer, for the default tests: every file of its corpus, then mutations of them, the
// same ones each time. REPLAY CORPUS_FOLDER MUTATIONS. What breaks the target is left in the file "broken_input".
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz_input.h"

namespace {

constexpr std::size_t largest_input = 1 << 16;  // [bytes]

// What parsers trip over.
constexpr std::array<std::string_view, 32> tokens{
    "nan", "inf",     "-inf",      "1e308",       "-1e308", "1e-320",   "99999999999999999999",
    "-1",  "0",       "0x7f",      "\n",          "\r\n",   "\t",       "#",
    ",",   ": ",      "[",         "]",           "{",      "}",        "&a ",
    "*a",  "\"\\n\"", "'",         "\xff",        "====\n", "\xc3\xa9", "\x1b[31m",
    "- ",  "? ",      "!!binary ", "\xef\xbb\xbf"};

const std::string* current_input = nullptr;

// Only calls that are allowed in a signal handler.
void keepBrokenInput(int signal) {
  const int file = ::open("broken_input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && ::write(file, current_input->data(), current_input->size()) >= 0) ::close(file);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

class Mutator {
 public:
  explicit Mutator(const std::vector<std::string>& corpus) : corpus_(corpus) {}

  std::string next() {
    std::string input = corpus_[below(corpus_.size())];
    for (std::size_t left = 1 + below(4); left > 0; --left) mutate(input);
    if (input.size() > largest_input) input.resize(largest_input);
    return input;
  }

 private:
  // The standard's distributions differ between libraries; this does not.
  std::size_t below(std::size_t end) { return static_cast<std::size_t>(random_() % end); }

  void mutate(std::string& input) {
    const std::size_t at = below(input.size() + 1);
    const std::size_t length = below(std::min<std::size_t>(input.size() - at, 64) + 1);
    const std::string_view token = tokens[below(tokens.size())];
    switch (below(8)) {
      case 0:
        if (at < input.size()) input[at] = static_cast<char>(input[at] ^ (1 << below(8)));
        break;
      case 1:
        if (at < input.size()) input[at] = static_cast<char>(below(256));
        break;
      case 2:
        input.resize(at);
        break;
      case 3:
        input.erase(at, length);
        break;
      case 4:
        input.insert(at, input.substr(at, length));
        break;
      case 5:
        input.insert(at, token);
        break;
      case 6:
        input.replace(at, length, token);
        break;
      default: {
        const std::string& other = corpus_[below(corpus_.size())];
        input = input.substr(0, at) + other.substr(below(other.size() + 1));
      }
    }
  }

  const std::vector<std::string>& corpus_;
  std::mt19937_64 random_{20'240'611};
};

std::vector<std::string> readCorpus(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

// A copy of the exact size, so that a sanitizer sees a read beyond its end.
void run(const std::string& input) {
  current_input = &input;
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::fprintf(stderr, "expected: CORPUS_FOLDER MUTATIONS\n");
    return 2;
  }
  const std::vector<std::string> corpus = readCorpus(arguments[1]);
  const long mutations = std::strtol(arguments[2], nullptr, 10);
  if (corpus.empty() || mutations < 1) {
    std::fprintf(stderr, "%s: no corpus, or nothing to do\n", arguments[1]);
    return 2;
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS}) std::signal(signal, keepBrokenInput);
  for (const std::string& input : corpus) run(input);
  Mutator mutator(corpus);
  for (long i = 0; i < mutations; ++i) run(mutator.next());
  std::printf("%zu files and %ld mutations\n", corpus.size(), mutations);
  return 0;
}
