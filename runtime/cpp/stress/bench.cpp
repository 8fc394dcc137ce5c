// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/bench.hpp"

#include <algorithm>
#include <optional>
#include <thread>
#include <utility>

#include "rr/error.hpp"

namespace rr::stress {

using test::stress::Stamp;
using Packet = std::optional<Stamp>;

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  return (a * 0x9e3779b97f4a7c15U) ^ (b + (a >> 7U));
}

std::uint64_t answered(std::uint64_t question) { return mixed(question, 17); }

// Parts

void Part::set_value(std::uint64_t value) {
  PartDefault::set_value(value);
  changed(value);
  level().set_in(value);
  samples().send(value);
}

void Part::enter_and_leave() {
  // Who is in the monitor is alone with the object, one call after the other.
  if (inside_ != 0 && inside_ != 1) shared_.lines.fault("a part has several in its monitor");
}

rr::Sequence<std::uint64_t> Part::count(std::uint64_t first, std::uint32_t steps) {
  const Counted counted(shared_.generators);
  for (std::uint32_t i = 0; i < steps; ++i) co_yield first + i;
}

bool Part::rr_monitor_enter(std::chrono::milliseconds timeout) {
  if (!monitor_.try_acquire_for(timeout)) return false;
  if (inside_.fetch_add(1) != 0) shared_.lines.fault("a monitor lets in a second one");
  return true;
}

void Part::rr_monitor_exit() {
  if (inside_.fetch_sub(1) != 1) shared_.lines.fault("a monitor is left by nobody");
  monitor_.release();
}

// The root

/// What is kept for a client while it is connected.
struct Bench::Client {
  explicit Client(Lines& lines, std::uint32_t endpoint)
      : target(lines, "target of client " + std::to_string(endpoint)) {}
  std::atomic<std::uint64_t> kept{0};
  Rising target;
};

Bench::Bench(Shared& shared, std::uint32_t clients) : shared_(shared) {
  const std::uint32_t places = clients * places_of_a_client;
  rr_memory_cells = std::make_shared<rr::StoredArrayMemory<std::uint32_t>>(std::size_t{places} *
                                                                           cells_of_a_place);
  const std::uint32_t rows = places * grid_height;
  rr_memory_grid = std::make_shared<rr::StoredMultiMemory<test::stress::Cell>>(
      rr::MultiArray<test::stress::Cell>{
          {grid_width, rows}, rr::Array<test::stress::Cell>(std::size_t{grid_width} * rows)});
}

Bench::~Bench() = default;

void Bench::rr_attached(ServiceContext& context, const std::string& /*path*/) {
  context_ = &context;
  serve_streams();
}

void Bench::serve_streams() {
  echo().on_connect([](rr::PipeEndpoint<Packet> end) {
    // The end keeps what its function holds until it is closed.
    end.on_packet([end](const Packet& packet) mutable {
         try {
           end.send(packet);
         } catch (const Error&) {  // closed meanwhile
         }
       })
        .detach();
  });
  mirror().on_connect([](rr::ServedWire<Packet> end) {
    end.on_out([end](const Packet& value, const rr::TimeSpec&) {
         try {
           rr::ServedWire<Packet>(end).set_in(value);
         } catch (const Error&) {
         }
       })
        .detach();
  });
  target().on_out([this](const Packet& value, const rr::TimeSpec&, std::uint32_t endpoint) {
    const std::lock_guard lock(mutex_);
    const auto place = clients_.find(endpoint);
    if (value && place != clients_.end()) place->second->target.take(value->number, "service");
  });
}

void Bench::remember(std::uint32_t endpoint) {
  const std::lock_guard lock(mutex_);
  clients_.emplace(endpoint, std::make_shared<Client>(shared_.lines, endpoint));
}

std::shared_ptr<Bench::Client> Bench::client(std::uint32_t endpoint) const {
  const std::lock_guard lock(mutex_);
  return clients_.at(endpoint);
}

void Bench::forget(std::uint32_t endpoint) {
  const std::lock_guard lock(mutex_);
  clients_.erase(endpoint);
}

std::uint64_t Bench::get_kept() { return client(ServiceContext::current_client())->kept; }

void Bench::set_kept(std::uint64_t value) {
  client(ServiceContext::current_client())->kept = value;
}

rr::Array<double> Bench::reversed(const rr::Array<double>& values) {
  rr::Array<double> result(values.size());
  const auto items = result.mutate();
  std::reverse_copy(values.data(), values.data() + values.size(), items.begin());
  return result;
}

void Bench::refuse(const std::string& text) { throw test::stress::Refused(text); }

void Bench::async_later(std::uint64_t value, rr::Answer<std::uint64_t> answer) {
  const std::lock_guard lock(mutex_);
  late_.push_back({value, answer.defer()});
}

std::uint64_t Bench::asked(std::uint64_t value) {
  return question(ServiceContext::current_client(), value);
}

std::int32_t Bench::asked_within(std::uint64_t value, std::uint32_t limit) {
  // NOLINTNEXTLINE(clang-analyzer-deadcode.DeadStores): is read when the question was not answered
  const auto begin = std::chrono::steady_clock::now();
  try {
    question(ServiceContext::current_client(), value, within(std::chrono::milliseconds(limit)));
    return 1;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::request_timeout) throw;
  }
  const auto took = std::chrono::steady_clock::now() - begin;
  if (took > std::chrono::milliseconds(limit) + shared_.longest_delay) {
    shared_.lines.fault("a callback takes longer than it may");
  }
  return 0;
}

void Bench::rest(std::uint32_t duration) {
  std::this_thread::sleep_for(std::chrono::milliseconds(duration));
}

void Bench::send_away() {
  if (ServiceContext* const context = context_) {
    context->disconnect(ServiceContext::current_client());
  }
}

void Bench::release(std::int32_t part) { release_object("parts[" + std::to_string(part) + "]"); }

void Bench::release_asking(std::int32_t part) {
  release_object("asking[" + std::to_string(part) + "]");
}

void Bench::release_object(const std::string& path) {
  if (ServiceContext* const context = context_) {
    context->release_path(context->name() + '.' + path);
  }
}

rr::Sequence<std::uint64_t> Bench::count(std::uint64_t first, std::uint32_t steps) {
  const Counted counted(shared_.generators);
  for (std::uint32_t i = 0; i < steps; ++i) co_yield first + i;
}

rr::Sequence<void, std::uint64_t> Bench::collect(std::uint64_t first) {
  const Counted counted(shared_.generators);
  for (std::uint64_t wanted = first;; ++wanted) {
    const std::uint64_t value = co_await rr::taken<std::uint64_t>;
    if (value == 0) co_return;
    if (value != wanted) shared_.lines.fault("a generator was given a value out of order");
  }
}

rr::Sequence<std::uint64_t, std::uint64_t> Bench::sum() {
  const Counted counted(shared_.generators);
  std::uint64_t total = 0;
  while (true) {
    total += co_await rr::taken<std::uint64_t>;
    co_yield total;
  }
}

std::shared_ptr<test::stress::PartSkeleton> Bench::get_parts(std::int32_t index) {
  if (index < 0 || index >= part_count) {
    throw Error(ErrorCode::key_not_found, "there is no such part");
  }
  return std::make_shared<Part>(shared_);
}

void Bench::answer_later() {
  std::vector<Late> late;
  {
    const std::lock_guard lock(mutex_);
    late.swap(late_);
  }
  for (Late& one : late) one.reply(mixed(one.value, 1));
}

std::shared_ptr<test::stress::PartSkeleton> Bench::get_asking(std::int32_t index) {
  question(ServiceContext::current_client(), static_cast<std::uint64_t>(index));
  return get_parts(index);
}

void Bench::produce(std::uint64_t random) {
  answer_later();
  const std::uint64_t number = level_number_ + 1;
  const std::size_t size = random % 7 == 0 ? 200 : random % 3;
  level().set_in(Stamp{0, number, rr::Array<double>(size)});
  level_number_ = number;
  ticked(tick_number_ + 1);
  ++tick_number_;
  for (std::uint64_t burst = random % 6; burst != 0; --burst) {
    // Who does not read for a while must not lose its end.
    if (!broadcast().wait_sent(std::chrono::milliseconds(20), std::size_t{4} * 1024 * 1024)) break;
    broadcast().send(Stamp{0, broadcast_number_ + 1, rr::Array<double>(size)});
    ++broadcast_number_;
  }
  if (lossy().wait_sent(std::chrono::milliseconds(0))) {
    lossy().send(Stamp{0, ++lossy_number_, {}});
  }
}

std::size_t Bench::left() const {
  std::size_t clients = 0;
  {
    const std::lock_guard lock(mutex_);
    clients = clients_.size();
  }
  return clients + broadcast().endpoint_count() + echo().endpoint_count() +
         lossy().endpoint_count() + level().connection_count() + mirror().connection_count() +
         target().connection_count() + static_cast<std::size_t>(shared_.generators.load());
}

std::string Bench::text() const {
  return "pipe ends " +
         std::to_string(broadcast().endpoint_count() + echo().endpoint_count() +
                        lossy().endpoint_count()) +
         ", wire ends " +
         std::to_string(level().connection_count() + mirror().connection_count() +
                        target().connection_count()) +
         ", generators " + std::to_string(shared_.generators.load());
}

}  // namespace rr::stress
