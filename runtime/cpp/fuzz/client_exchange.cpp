// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/client_exchange.hpp"

#include <sanitizer/allocator_interface.h>
#include <sanitizer/lsan_interface.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>

// Less of both than usual: a client allocates much, and for a short time only.
extern "C" const char* __asan_default_options() {
  return "quarantine_size_mb=64:malloc_context_size=8";
}

namespace rr::fuzz {
namespace {

constexpr std::uint64_t runs_per_check = 1024;
constexpr std::uint64_t runs_per_search_for_leaks = 16384;
constexpr unsigned most_threads_of_node = 4;
// Those of both nodes, of the fuzzer and its own.
constexpr std::size_t most_threads = 2 * (most_threads_of_node + 2) + 4;
// The fuzzer keeps its corpus in the same memory.
constexpr std::size_t most_growth = std::size_t{128} * 1024 * 1024;
constexpr std::uint32_t largest_message = 64 * 1024;

std::size_t count_threads() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return static_cast<std::size_t>(std::distance(begin(tasks), end(tasks)));
}

void print(const char* what, const std::vector<int>& outcomes) {
  std::fputs(what, stderr);
  for (const int outcome : outcomes) std::fprintf(stderr, " %d", outcome);
  std::fputs("\n", stderr);
}

std::vector<RecordedService::Program> recordable(std::span<ClientProgram* const> programs,
                                                 std::vector<std::vector<int>>& outcomes) {
  std::vector<RecordedService::Program> result;
  for (ClientProgram* const program : programs) {
    result.emplace_back([program, &outcomes](Node& node, std::string_view url) {
      Attempts attempts;
      program(node, url, attempts);
      outcomes.push_back(attempts.outcomes());
    });
  }
  return result;
}

NodeOptions options_of(bool offers_v4, const std::shared_ptr<MessageChannel>& channel) {
  // The service answers before the client begins to wait: what is not there by then is left out.
  constexpr std::chrono::milliseconds shortly{4};
  NodeOptions options;
  options.name = client_node_name;
  options.id = client_node();
  options.max_threads = most_threads_of_node;
  options.client_offer.message_v4 = offers_v4;
  options.request_timeout = shortly;
  options.connect_timeout = shortly * 5;
  options.definitions.timeout = shortly * 5;
  options.limits.message_size = largest_message;
  options.log = [](LogLevel, std::string_view) {};
  options.channels = {{std::string(hostile_scheme), channel}};
  return options;
}

}  // namespace

ClientExchange::Side::Side(bool offers_v4, std::span<ClientProgram* const> programs)
    : recorded(offers_v4, recordable(programs, outcomes)),
      channel(std::make_shared<HostileChannel>(recorded)),
      node(options_of(offers_v4, channel)) {}

void ClientExchange::Side::run(ClientProgram* program, std::span<const std::byte> input,
                               Attempts& attempts) {
  channel->follow(input);
  program(node, hostile_url, attempts);
  await("a connection that is closed goes", [&] { return channel->links() == 0; });
  for (const std::weak_ptr<Session>& session : attempts.sessions()) {
    await("a session that is closed goes", [&] { return session.expired(); });
  }
}

ClientExchange::ClientExchange(std::span<ClientProgram* const> programs)
    : programs_(programs), v2_(false, programs), v4_(true, programs) {
  check_all();
  memory_ = __sanitizer_get_current_allocated_bytes();
}

void ClientExchange::run(std::span<const std::byte> input) {
  const std::size_t first = take_byte(input);
  Side& side = first % 2 == 0 ? v4_ : v2_;
  Attempts attempts;
  side.run(programs_[first / 2 % programs_.size()], input, attempts);
  if (++runs_ % runs_per_check == 0) check_all();
  if (runs_ % runs_per_search_for_leaks == 0) {
    promise(__lsan_do_recoverable_leak_check() == 0, "no memory is lost");
  }
}

void ClientExchange::check_all() {
  for (Side* const side : {&v2_, &v4_}) {
    for (std::size_t i = 0; i < programs_.size(); ++i) {
      // Short time-outs may be over on a busy machine before a program is given the processor.
      constexpr std::chrono::seconds patience{40};
      const auto end = std::chrono::steady_clock::now() + patience;
      std::vector<int> outcomes;
      do {
        Attempts attempts;
        side->run(programs_[i], {}, attempts);
        outcomes = attempts.outcomes();
      } while (outcomes != side->outcomes[i] && std::chrono::steady_clock::now() < end);
      if (outcomes == side->outcomes[i]) continue;
      std::fprintf(stderr, "program %zu\n", i);
      print("  before:", side->outcomes[i]);
      print("  now:   ", outcomes);
      promise(false, "an honest service is used as before");
    }
  }
  promise(count_threads() <= most_threads, "there are no more threads than before");
  promise(memory_ == 0 || __sanitizer_get_current_allocated_bytes() < memory_ + most_growth,
          "there is no more memory in use than before");
}

}  // namespace rr::fuzz
