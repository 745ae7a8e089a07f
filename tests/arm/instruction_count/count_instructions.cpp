// A plugin of QEMU's user mode (Debian package qemu-user) that counts instructions: all of a program, and those of each
// call of one function with all that it calls.
//
//     qemu-aarch64 -plugin libcount_instructions.so,function=PART_OF_SYMBOL,caller=PART_OF_SYMBOL PROGRAM ...
//
// A call ends when the caller goes on. What is declared here is QEMU's interface for plugins, version 1.
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

extern "C" {
struct qemu_plugin_tb;
struct qemu_plugin_insn;
struct qemu_info_t;
void qemu_plugin_register_vcpu_tb_trans_cb(std::uint64_t id, void (*callback)(std::uint64_t, qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_cb(qemu_plugin_tb* block, void (*callback)(unsigned int, void*), int flags,
                                          void* data);
void qemu_plugin_register_atexit_cb(std::uint64_t id, void (*callback)(std::uint64_t, void*), void* data);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb* block);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb* block, std::size_t index);
const char* qemu_plugin_insn_symbol(const qemu_plugin_insn* instruction);

__attribute__((visibility("default"))) extern int qemu_plugin_version;
__attribute__((visibility("default"))) int qemu_plugin_install(std::uint64_t id, const qemu_info_t* info,
                                                               int argument_count, char** arguments);
int qemu_plugin_version = 1;
}

namespace {

// A processor is a thread of the program.
constexpr std::size_t processors = 256;

enum class Block : std::uintptr_t { other, function, caller };

struct Count {
  std::uint64_t all = 0;
  std::uint64_t call = 0;
  bool in_call = false;
};

struct Counts {
  std::string function, caller;
  std::array<Count, processors> of_processor;
  std::vector<std::uint64_t> calls;
};

// QEMU's callbacks take no object along.
Counts& counts() {
  static Counts all;
  return all;
}

// `data`: the number of instructions, times 4, plus the kind of block.
void execute(unsigned int processor, void* data) {
  const auto packed = reinterpret_cast<std::uintptr_t>(data);
  const std::uint64_t instructions = packed >> 2U;
  Count& count = counts().of_processor[processor % processors];
  count.all += instructions;
  const auto block = static_cast<Block>(packed & 3U);
  if (block == Block::function) {
    count.in_call = true;
  } else if (block == Block::caller && count.in_call) {
    counts().calls.push_back(count.call);
    count = {count.all, 0, false};
  }
  if (count.in_call) count.call += instructions;
}

void translate(std::uint64_t, qemu_plugin_tb* block) {
  const std::size_t instructions = qemu_plugin_tb_n_insns(block);
  if (instructions == 0) return;
  const char* name = qemu_plugin_insn_symbol(qemu_plugin_tb_get_insn(block, 0));
  const std::string symbol = name == nullptr ? "" : name;
  Block kind = Block::other;
  if (symbol.find(counts().function) != std::string::npos) kind = Block::function;
  if (symbol.find(counts().caller) != std::string::npos) kind = Block::caller;
  const std::uintptr_t packed = instructions << 2U | static_cast<std::uintptr_t>(kind);
  qemu_plugin_register_vcpu_tb_exec_cb(block, execute, 0, reinterpret_cast<void*>(packed));
}

void report(std::uint64_t, void*) {
  std::uint64_t all = 0;
  for (const Count& count : counts().of_processor) all += count.all;
  std::vector<std::uint64_t> calls = counts().calls;
  std::sort(calls.begin(), calls.end());
  std::uint64_t sum = 0;
  for (const std::uint64_t call : calls) sum += call;
  std::fprintf(stderr, "instructions %" PRIu64 "\ncalls %zu\n", all, calls.size());
  if (calls.empty()) return;
  std::fprintf(stderr, "mean %" PRIu64 "\nmedian %" PRIu64 "\nmost %" PRIu64 "\n", sum / calls.size(),
               calls[calls.size() / 2], calls.back());
}

}  // namespace

int qemu_plugin_install(std::uint64_t id, const qemu_info_t*, int argument_count, char** arguments) {
  for (int i = 0; i < argument_count; ++i) {
    const std::string argument = arguments[i];
    if (argument.rfind("function=", 0) == 0) counts().function = argument.substr(9);
    if (argument.rfind("caller=", 0) == 0) counts().caller = argument.substr(7);
  }
  if (counts().function.empty() || counts().caller.empty()) {
    std::fprintf(stderr, "count_instructions: expected function=PART_OF_SYMBOL and caller=PART_OF_SYMBOL\n");
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_atexit_cb(id, report, nullptr);
  return 0;
}
