// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <semaphore>
#include <string>
#include <vector>

#include "rr/service.hpp"
#include "runtime/cpp/stress/faults.hpp"
#include "test/stress.hpp"

namespace rr::stress {

constexpr std::int32_t part_count = 16;
/// Sessions take turns in using a place of the memories.
constexpr std::uint32_t places_of_a_client = 4;
constexpr std::uint32_t cells_of_a_place = 30'000;  // more than travels in one request
constexpr std::uint32_t grid_width = 40;
constexpr std::uint32_t grid_height = 8;

/// What the functions of the service compute.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b);
std::uint64_t answered(std::uint64_t question);

/// Counts objects that are alive.
class Counted {
 public:
  explicit Counted(std::atomic<int>& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<int>& count_;
};

/// What the objects of the service have in common; outlives them.
struct Shared {
  explicit Shared(Lines& out) : lines(out) {}
  Lines& lines;
  std::atomic<int> generators{0};
  std::atomic<int> parts{0};
  std::chrono::milliseconds longest_delay{10'000};  ///< of a thread, beyond what it waits for
};

class Part final : public test::stress::PartDefault {
 public:
  explicit Part(Shared& shared) : shared_(shared), counted_(shared.parts) {}

  void set_value(std::uint64_t value) override;
  void enter_and_leave() override;
  rr::Sequence<std::uint64_t> count(std::uint64_t first, std::uint32_t steps) override;

  [[nodiscard]] bool rr_has_monitor() const override { return true; }
  bool rr_monitor_enter(std::chrono::milliseconds timeout) override;
  void rr_monitor_exit() override;

 private:
  Shared& shared_;
  const Counted counted_;
  std::binary_semaphore monitor_{1};
  std::atomic<int> inside_{0};
};

class Bench final : public test::stress::BenchDefault {
 public:
  Bench(Shared& shared, std::uint32_t clients);
  ~Bench() override;

  void rr_attached(ServiceContext& context, const std::string& path) override;
  std::uint64_t get_kept() override;
  void set_kept(std::uint64_t value) override;
  std::uint64_t mix(std::uint64_t a, std::uint64_t b) override { return mixed(a, b); }
  rr::Array<double> reversed(const rr::Array<double>& values) override;
  void refuse(const std::string& text) override;
  void async_later(std::uint64_t value, rr::Answer<std::uint64_t> answer) override;
  std::uint64_t asked(std::uint64_t value) override;
  std::int32_t asked_within(std::uint64_t value, std::uint32_t limit) override;
  std::uint64_t level_number() override { return level_number_; }
  std::uint64_t tick_number() override { return tick_number_; }
  std::uint64_t broadcast_number() override { return broadcast_number_; }
  void rest(std::uint32_t duration) override;
  void send_away() override;
  void release(std::int32_t part) override;
  void release_asking(std::int32_t part) override;
  rr::Sequence<std::uint64_t> count(std::uint64_t first, std::uint32_t steps) override;
  rr::Sequence<void, std::uint64_t> collect(std::uint64_t first) override;
  rr::Sequence<std::uint64_t, std::uint64_t> sum() override;
  std::shared_ptr<test::stress::PartSkeleton> get_parts(std::int32_t index) override;
  std::shared_ptr<test::stress::PartSkeleton> get_asking(std::int32_t index) override;

  /// One round of what goes to all clients.
  void produce(std::uint64_t random);
  /// What is kept for a client.
  void remember(std::uint32_t endpoint);
  void forget(std::uint32_t endpoint);
  /// Ends of pipes and wires, and generators, that are left.
  [[nodiscard]] std::size_t left() const;
  [[nodiscard]] std::string text() const;

 private:
  struct Client;
  void serve_streams();
  void release_object(const std::string& path);
  [[nodiscard]] std::shared_ptr<Client> client(std::uint32_t endpoint) const;
  void answer_later();

  Shared& shared_;
  std::atomic<ServiceContext*> context_{nullptr};
  std::atomic<std::uint64_t> level_number_{0};
  std::atomic<std::uint64_t> tick_number_{0};
  std::atomic<std::uint64_t> broadcast_number_{0};
  std::atomic<std::uint64_t> lossy_number_{0};

  mutable std::mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<Client>> clients_;
  struct Late {
    std::uint64_t value;
    rr::Reply<std::uint64_t> reply;
  };
  std::vector<Late> late_;
};

}  // namespace rr::stress
