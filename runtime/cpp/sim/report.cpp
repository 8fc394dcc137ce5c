// SPDX-License-Identifier: Apache-2.0
// What a person reads when a run has failed.
#include <cxxabi.h>
#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/sim/network.hpp"
#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {
namespace {

constexpr int exit_code_of_failures = 3;
constexpr std::size_t longest_name = 110;

std::size_t steps_to_print() {
  const char* const wanted = std::getenv("RR_SIM_STEPS");
  return wanted == nullptr ? 60 : static_cast<std::size_t>(std::strtoul(wanted, nullptr, 10));
}

std::string shortened(std::string name) {
  if (name.size() > longest_name) name = name.substr(0, longest_name) + "...";
  return name;
}

std::string demangled(const char* symbol) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> text(
      abi::__cxa_demangle(symbol, nullptr, nullptr, &status), &std::free);
  return status == 0 ? text.get() : symbol;
}

// Of functions that the program does not export: asks addr2line(1), which reads all its symbols,
// once for all.
std::map<const void*, std::string> names_of(const std::set<const void*>& addresses) {
  Dl_info program{};
  dladdr(reinterpret_cast<const void*>(&names_of), &program);
  std::string command = "addr2line -f -C -e /proc/" + std::to_string(getpid()) + "/exe";
  std::vector<const void*> asked;
  for (const void* const address : addresses) {
    Dl_info found{};
    if (dladdr(address, &found) == 0 || found.dli_fbase != program.dli_fbase) continue;
    std::array<char, 32> text{};
    std::snprintf(
        text.data(), text.size(), " %#tx",
        static_cast<const char*>(address) - 1 - static_cast<const char*>(program.dli_fbase));
    command += text.data();
    asked.push_back(address);
  }
  std::map<const void*, std::string> names;
  std::FILE* const answers =
      asked.empty() ? nullptr : popen((command + " 2>/dev/null").c_str(), "r");
  if (answers == nullptr) return names;
  std::array<char, 4096> line{};
  for (const void* const address : asked) {
    if (std::fgets(line.data(), line.size(), answers) == nullptr) break;
    std::string name = line.data();
    if (!name.empty()) name.pop_back();
    names[address] = shortened(std::move(name));
    std::fgets(line.data(), line.size(), answers);  // file and line
  }
  pclose(answers);
  return names;
}

}  // namespace

std::string function_at(const void* address) {
  Dl_info found{};
  if (address == nullptr || dladdr(address, &found) == 0) return "?";
  if (found.dli_sname != nullptr) return shortened(demangled(found.dli_sname));
  const auto names = names_of({address});
  return names.empty() ? "?" : names.begin()->second;
}

Trace::Trace()
    : steps_(static_cast<Step*>(::mmap(nullptr, most_kept * sizeof(Step), PROT_READ | PROT_WRITE,
                                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0))),
      kept_(std::bit_ceil(std::clamp(steps_to_print(), std::size_t{1}, most_kept))) {
  if (steps_ == MAP_FAILED) std::abort();
}

Trace::~Trace() { ::munmap(steps_, most_kept * sizeof(Step)); }

void Trace::print(std::FILE* file, std::size_t most) const {
  // Objects have numbers here: addresses say nothing.
  std::map<const void*, std::size_t> names;
  const std::uint64_t kept = std::min<std::uint64_t>({count_, kept_, most});
  std::set<const void*> callers;
  for (std::uint64_t i = count_ - kept; i < count_; ++i) {
    callers.insert(steps_[i & (kept_ - 1)].caller);
  }
  callers.erase(nullptr);
  const auto functions = names_of(callers);
  for (std::uint64_t i = count_ - kept; i < count_; ++i) {
    const Step& step = steps_[i & (kept_ - 1)];
    std::string object;
    if (step.object != nullptr) {
      object = " #" + std::to_string(names.try_emplace(step.object, names.size()).first->second);
    }
    std::fprintf(file, "%14.6f s  thread %-3d %s%s", static_cast<double>(step.time) / 1e9,
                 step.thread, step.what, object.c_str());
    if (step.amount > 0) std::fprintf(file, " (%lld)", static_cast<long long>(step.amount));
    const auto function = functions.find(step.caller);
    if (function != functions.end()) std::fprintf(file, "  in %s", function->second.c_str());
    std::fputc('\n', file);
  }
}

void Scheduler::fail(const std::string& why) {
  leave_run();  // the report is made by a thread of the system, with its files and programs
  std::fprintf(stdout, "FAILED at %.6f s: %s\n", static_cast<double>(now_) / 1e9, why.c_str());
  std::fprintf(stdout, "threads:\n%s", threads_text().c_str());
  if (Network* const network = Network::current()) {
    std::fprintf(stdout, "network: %s\n", network->text().c_str());
  }
  const std::size_t steps = steps_to_print();
  if (steps != 0) {
    std::fprintf(stdout, "what happened:\n");
    for (const Note& note : notes_) {
      std::fprintf(stdout, "%14.6f s  thread %-3d %s\n", static_cast<double>(note.time) / 1e9,
                   note.thread, note.text.c_str());
    }
    std::fprintf(stdout, "last steps:\n");
    trace_.print(stdout, steps);
  }
  std::fflush(stdout);
  _exit(exit_code_of_failures);
}

}  // namespace rr::sim
