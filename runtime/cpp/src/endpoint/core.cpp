// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/core.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/tap.hpp"
#include "rr/url.hpp"
#include "rr/version.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/channel/status.hpp"
#include "runtime/cpp/src/endpoint/timer.hpp"
#include "runtime/cpp/src/platform/random.hpp"

namespace rr::endpoint {
namespace {

constexpr std::chrono::seconds longest_round{5};

// As the rest of the runtime relies on: checked, with an id, and with times that can be added.
std::shared_ptr<const NodeOptions> completed(NodeOptions options) {
  if (!options.name.empty() && !Url::is_node_name(options.name)) {
    throw Error(ErrorCode::invalid_argument,
                "`" + options.name + "` is no name for a node: a letter, then letters, digits, " +
                    "`_`, `.` and `-`, 1024 at most");
  }
  if (options.id.is_any()) {
    options.id = options.tls.certificate_file.empty() ? NodeId::random()
                                                      : channel::certified_id(options.tls);
  }
  for (channel::Milliseconds* const time :
       {&options.request_timeout, &options.connect_timeout, &options.first_message_timeout,
        &options.heartbeat_period, &options.receive_timeout, &options.keep_alive_period,
        &options.client_timeout, &options.generator_timeout, &options.local.heartbeat_period,
        &options.local.receive_timeout, &options.login.first_delay, &options.login.max_delay,
        &options.login.memory}) {
    *time = channel::saturated(*time);
  }
  return std::make_shared<const NodeOptions>(std::move(options));
}

}  // namespace

namespace {

// Says what went wrong where nobody else can be told, and the core may be gone.
std::function<void(std::string_view)> error_log(std::shared_ptr<const NodeOptions> options) {
  return [options = std::move(options)](std::string_view text) {
    channel::log(*options, LogLevel::error, text);
  };
}

channel::Reactor::Terms reactor_terms(const std::shared_ptr<const NodeOptions>& options) {
  return {.max_threads = options->max_threads,
          .session_threads = std::max(options->session_threads, 1U),
          .report = error_log(options),
          .metrics = options->metrics.is_enabled ? std::make_shared<channel::Metrics>() : nullptr};
}

// What the node holds and runs, beside what it has counted.
void write_state(channel::MetricsText& text, const channel::Reactor& reactor,
                 const channel::Pools& pools) {
  text.begin(
      {"robdef_budget_used_bytes", "gauge", "Bytes that peers make this node hold.", "bytes"});
  text.sample("", {{"pool", "sessions"}}, std::uint64_t{pools.sessions->held()});
  text.sample("", {{"pool", "before_session"}}, std::uint64_t{pools.before_session->held()});
  text.begin({"robdef_budget_limit_bytes", "gauge", "How many they may.", "bytes"});
  text.sample("", {{"pool", "sessions"}}, std::uint64_t{pools.sessions->limit()});
  text.sample("", {{"pool", "before_session"}}, std::uint64_t{pools.before_session->limit()});
  text.begin({"robdef_threads", "gauge", "Threads of the node; held: by handlers that block."});
  text.sample("", {{"state", "live"}}, std::uint64_t{reactor.live_threads()});
  text.sample("", {{"state", "held"}}, std::uint64_t{reactor.held()});
  text.gauge({"robdef_work_waiting", "gauge", "Handlers that wait for a thread."},
             reactor.waiting());
}

}  // namespace

class Core::Rounds final : public channel::Timer, public std::enable_shared_from_this<Rounds> {
 public:
  Rounds(std::shared_ptr<channel::Reactor> reactor, channel::Milliseconds period)
      : reactor_(std::move(reactor)), period_(period) {}
  ~Rounds() { reactor_->cancel(*this); }

  void add(std::weak_ptr<Attended> endpoint) {
    {
      const MutexLock lock(mutex_);
      attended_.push_back(std::move(endpoint));
      if (attended_.size() != 1) return;
    }
    schedule();
  }

 private:
  void on_timer() override {
    std::vector<std::shared_ptr<Attended>> alive;
    {
      const MutexLock lock(mutex_);
      std::erase_if(attended_, [&](const std::weak_ptr<Attended>& endpoint) {
        alive.push_back(endpoint.lock());
        return alive.back() == nullptr;
      });
    }
    std::erase(alive, nullptr);
    const channel::Time now = channel::Clock::now();
    for (const std::shared_ptr<Attended>& endpoint : alive) endpoint->attend(now);
    if (!alive.empty()) {
      schedule();
      return;
    }
    const MutexLock lock(mutex_);
    if (!attended_.empty()) schedule();
  }

  void schedule() { reactor_->schedule(*this, weak_from_this(), channel::Clock::now() + period_); }

  const std::shared_ptr<channel::Reactor> reactor_;
  const channel::Milliseconds period_;
  Mutex mutex_;
  std::vector<std::weak_ptr<Attended>> attended_ RR_GUARDED_BY(mutex_);
};

namespace {

// Of the wires that a node publishes in shared memory: memory, and a descriptor for each.
constexpr channel::SlotBudget::Limits node_slots{.bytes = std::size_t{256} * 1024 * 1024,
                                                 .count = 256};
// One thread of so many may sleep on a wire of another node.
constexpr unsigned slot_thread_share = 4;

}  // namespace

Core::Core(NodeOptions options)
    : options_(completed(std::move(options))),
      reactor_(std::make_shared<channel::Reactor>(reactor_terms(options_))),
      accepted_(std::make_shared<channel::Admission>(options_, reactor_->shared_metrics())),
      pools_(channel::make_pools(*options_)),
      slot_budget_(std::make_shared<channel::SlotBudget>(node_slots)),
      slot_threads_(std::make_shared<channel::SlotBudget>(
          channel::SlotBudget::Limits{.count = options_->max_threads / slot_thread_share})),
      types_(std::make_shared<const TypeRegistry>()) {
  const auto limit = std::min(
      {options_->keep_alive_period, options_->client_timeout, options_->generator_timeout});
  const auto period = std::clamp<channel::Milliseconds>(limit / 4, channel::Milliseconds(10),
                                                        channel::Milliseconds(longest_round));
  rounds_ = std::make_shared<Rounds>(reactor_, period);
  channel::watch_pools(pools_, reactor_);
  std::function<void(LogLevel, std::string_view)> tls_log;
  if (channel::has_log(*options_)) {
    tls_log = [options = options_](LogLevel level, std::string_view text) {
      channel::log(*options, level, text);
    };
  }
  tls_ = channel::make_tls(options_->tls, options_->id, reactor_, tls_log);
  make_status();
  web_sockets_ = channel::make_web_sockets(options_->web_socket, status_);
  channels_ = channel::all_channels(context());
}

Core::~Core() { stop(); }

void Core::make_status() {
  if (!options_->metrics.is_enabled) return;
  status_ = std::make_shared<channel::Status>(options_->metrics);
  status_->add(
      [options = options_, reactor = reactor_, pools = pools_](channel::MetricsText& text) {
        text.begin({"robdef_node", "info", "This node."});
        text.sample("_info",
                    {{"node_id", options->id.text()},
                     {"node_name", options->name},
                     {"version", std::string(library_version())}},
                    std::uint64_t{1});
        reactor->metrics()->write(text);
        write_state(text, *reactor, pools);
      });
}

void Core::log(LogLevel level, std::string_view text) const {
  channel::log(*options_, level, text);
}

rr::Timer Core::every(std::chrono::nanoseconds period, std::function<void()> work) {
  if (period <= std::chrono::nanoseconds(0)) {
    throw Error(ErrorCode::invalid_argument, "the period of a timer is longer than nothing");
  }
  return start_timer(period, period, std::move(work));
}

rr::Timer Core::after(std::chrono::nanoseconds delay, std::function<void()> work) {
  return start_timer(delay, std::chrono::nanoseconds(0), std::move(work));
}

rr::Timer Core::start_timer(std::chrono::nanoseconds delay, std::chrono::nanoseconds period,
                            std::function<void()> work) {
  if (!work) throw Error(ErrorCode::invalid_argument, "a timer needs a function");
  if (reactor_->is_stopping()) throw Error(ErrorCode::invalid_operation, "the node is shut down");
  start();
  const auto state = std::make_shared<rr::Timer::State>(
      reactor_, rr::Timer::State::Terms{.delay = delay,
                                        .period = period,
                                        .work = std::move(work),
                                        .report = error_log(options_)});
  state->start();
  return rr::Timer(state);
}

void Core::add_definition(const Definition& definition) {
  tell_tap(definition);
  const MutexLock lock(mutex_);
  if (types_->find_definition(definition.name) == &definition) return;
  auto types = std::make_shared<TypeRegistry>(*types_);
  types->add(definition);
  types_ = std::move(types);
}

void Core::keep_definition(std::shared_ptr<const Definition> definition) {
  const Definition& kept = *definition;
  {
    const MutexLock lock(mutex_);
    kept_definitions_.insert(std::move(definition));
  }
  add_definition(kept);
}

void Core::tell_tap(const Definition& definition) const {
  if (!options_->tap) return;
  options_->tap->definition(definition.text);
  for (const Definition* import : definition.imports) tell_tap(*import);
}

std::shared_ptr<const TypeRegistry> Core::types() const {
  const MutexLock lock(mutex_);
  return types_;
}

std::uint32_t Core::new_endpoint() {
  const platform::RandomNumbers random;
  const MutexLock lock(mutex_);
  while (true) {
    const std::uint32_t number = random();
    if (number != 0 && endpoints_.insert(number).second) return number;
  }
}

void Core::release_endpoint(std::uint32_t number) {
  const MutexLock lock(mutex_);
  endpoints_.erase(number);
}

channel::Channel& Core::channel(const std::string& scheme) {
  const MutexLock lock(mutex_);
  const auto found = channels_.find(scheme);
  if (found == channels_.end()) {
    const std::string component = channel::missing_component(scheme);
    throw Error(ErrorCode::invalid_argument,
                "there is no channel for `" + scheme + "://`" +
                    (scheme == "rr+serial" ? ": give the node rr::serial_channel()" : "") +
                    (component.empty() ? "" : ": link the program with " + component));
  }
  return *found->second;
}

void Core::add_channel(const std::string& scheme, std::shared_ptr<channel::Channel> channel) {
  const MutexLock lock(mutex_);
  channels_[scheme] = std::move(channel);
}

void Core::attend(std::weak_ptr<Attended> endpoint) { rounds_->add(std::move(endpoint)); }

}  // namespace rr::endpoint
