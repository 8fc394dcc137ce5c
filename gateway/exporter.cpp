// SPDX-License-Identifier: Apache-2.0
#include "gateway/exporter.hpp"

#include <unistd.h>

#include <array>
#include <future>
#include <set>
#include <utility>

#include "gateway/clock_watch.hpp"
#include "gateway/elements.hpp"
#include "gateway/exported_wires.hpp"
#include "gateway/node_claim.hpp"
#include "gateway/properties.hpp"
#include "gateway/service_exporter.hpp"
#include "gateway/value_claim.hpp"
#include "gateway/value_handler.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::milliseconds export_tick{20};
constexpr std::chrono::seconds stream_tick{1};
constexpr std::chrono::seconds status_period{2};
constexpr std::chrono::minutes left_idle{10};
/// The farewell waits so long at most for values that are on their way.
constexpr std::chrono::milliseconds values_end{200};

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace

std::int64_t wall_time() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

ServiceExporter::ServiceExporter(ServiceAddress address, ExportedServiceOptions options,
                                 std::string folder, Shared shared)
    : address_(std::move(address)),
      options_(std::move(options)),
      folder_(std::move(folder)),
      shared_(std::move(shared)),
      window_(folder_ + "/$calls", {}, wall_time()),
      callbacks_(std::make_shared<ExportedCallbacks>(shared_.worker, shared_.outbox,
                                                     ExportedCallbacks::Limits(), shared_.pump)),
      sessions_(shared_.worker, {.silence = options_.session_limit},
                [this](const std::string& session, const std::string& reply_topic) {
                  tell_ended(session, reply_topic);
                }) {}

void ServiceExporter::connect(Node& node) {
  node_ = &node;
  publish_life("down", "not connected yet");
  RobotSession::Listener listener;
  const Weak weak = shared_from_this();
  listener.connected = [weak](const dynamic::Object& root) {
    const Self self = weak.lock();
    if (!self) return;
    self->shared_.worker.post([weak, root] {
      if (const Self exporter = weak.lock()) exporter->robot_connected(root);
    });
  };
  listener.disconnected = [weak](const std::string& reason) {
    const Self self = weak.lock();
    if (!self) return;
    self->shared_.worker.post([weak, reason] {
      if (const Self exporter = weak.lock()) exporter->robot_disconnected(reason);
    });
  };
  listener.released = [weak](const std::string& path) {
    const Self self = weak.lock();
    if (!self) return;
    self->shared_.worker.post([weak, path] {
      if (const Self exporter = weak.lock()) exporter->object_released(path);
    });
  };
  session_ = RobotSession::open(node, options_.url, options_.login, std::move(listener));
}

std::vector<std::string> ServiceExporter::filters() const {
  std::vector<std::string> all;
  for (const Verb verb : all_verbs) all.push_back(request_filter(address_, verb));
  return all;
}

bool ServiceExporter::pump_retained(Carrier& carrier) {
  while (!unpublished_.empty()) {
    const Message& message = retained_.at(*unpublished_.begin());
    const Published result = carrier.publish(message);
    if (result == Published::later) return false;
    if (result == Published::refused) {
      shared_.log(LogLevel::error, message.topic + ": too large for the broker");
    }
    unpublished_.erase(unpublished_.begin());
  }
  return true;
}

bool ServiceExporter::pump(Carrier& carrier) {
  if (!pump_retained(carrier)) return false;
  for (auto& [topic, stream] : streams_) {
    while (const auto message = stream.writer->next()) {
      const Published result = carrier.publish(*message);
      stream.writer->done(result);
      if (result == Published::later) return false;
    }
  }
  return true;
}

void ServiceExporter::clock_was_set(std::int64_t by) {
  window_.clock_was_set(by);
  for (auto& [topic, stream] : streams_) stream.writer->clock_was_set(by);
}

void ServiceExporter::tick() {
  const auto now = std::chrono::steady_clock::now();
  window_.forget_old(wall_time());
  callbacks_->tick(now);
  sessions_.tick(now);
  generators_.end_idle(now, left_idle);
  endpoints_.close_idle(now, left_idle);
  attach_closed(now);
  for (auto& [topic, stream] : streams_) {
    stream.writer->flush(now);
    if (now - stream.ticked < stream_tick) continue;
    stream.ticked = now;
    stream.writer->tick(now, wall_time());
  }
  if (now - status_told_ < status_period) return;
  status_told_ = now;
  publish_status();
}

/// All of it, behind a pointer so that the handler's address stays.
class Exporter::Core final : public CarrierHandler {
 public:
  Core(ExportFile file, const Carriers& carriers, Log log, Refused refused)
      : file_(std::move(file)),
        carrier_(*carriers.messages),
        values_(*carriers.values),
        log_(std::move(log)),
        refused_(std::move(refused)),
        claim_(node_topic(file_.site, file_.node), wall_time(), host_name()),
        worker_(std::make_unique<Worker>(export_tick, [this] { tick(); })),
        value_handler_(*worker_, values_, log_,
                       {.message = [this](const Message& message) { take_of_values(message); },
                        .connected = [this] { set_values_connected(true); },
                        .disconnected = [this] { set_values_connected(false); },
                        .room = [this] { resume_values(); }}) {
    for (ExportedServiceOptions& options : file_.services) add(options);
  }

  void start() {
    worker_->start();
    worker_->post([this] {
      for (const auto& service : services_) service->connect(node_);
    });
    carrier_.subscribe(claim_.life_topic());
    carrier_.subscribe(claim_.claim_topic());
    carrier_.start(*this, claim_.life("lost"));
    values_.subscribe(claim_.life_topic());
    values_.start(value_handler_, {});
  }

  void stop() {
    // Of a node that is not this gateway's there is nothing to say.
    std::promise<bool> has_node;
    worker_->post([&] {
      ends_ = true;
      has_node.set_value(holds_node());
    });
    const bool has_farewell = has_node.get_future().get();
    // Both at once where a link is down. Otherwise the farewell comes after the last value.
    const auto values_ended = std::async(std::launch::async, [this] { values_.stop({}); });
    if (has_farewell) values_ended.wait_for(values_end);
    carrier_.stop(has_farewell ? claim_.life("ended") : Message());
    values_ended.wait();
    worker_->stop();
    services_.clear();
    // Its threads may be in a handler of a service that was only just released, and such handlers
    // post to the worker.
    node_.shutdown();
  }

  void on_message(Message message) override {
    if (!worker_->has_room()) return;
    worker_->post([this, message = std::move(message)] { take(message); });
  }
  void on_connected() override {
    worker_->post([this] {
      is_connected_ = true;
      reason_.clear();
      log_(LogLevel::info, "connected to " + carrier_.url());
      claim_.connected();
      pump_claim();
    });
  }
  void on_disconnected(const std::string& reason) override {
    worker_->post([this, reason] {
      is_connected_ = false;
      refusals_.clear();
      claim_.disconnected();
      pump_values();
      outbox_.clear();
      if (std::exchange(reason_, reason) != reason) log_(LogLevel::warning, reason);
    });
  }
  void on_room() override {
    worker_->post([this] { pump(); });
  }
  void on_refused(const Refusal& refusal) override {
    worker_->post([this, refusal] {
      if (refusals_.insert(refusal.topic).second) log_(LogLevel::error, refusal.text());
    });
  }

 private:
  void add(ExportedServiceOptions& options) {
    ServiceAddress address{file_.site, file_.node, options.name};
    const std::string folder = file_.state_folder + "/" + options.name;
    services_.push_back(std::make_shared<ServiceExporter>(
        std::move(address), options, folder,
        ServiceExporter::Shared{*worker_, outbox_, wires_, log_, [this] { pump(); },
                                [this] { pump_values(); }}));
    for (const std::string& filter : services_.back()->filters()) carrier_.subscribe(filter);
  }

  [[nodiscard]] bool holds_node() const {
    return is_connected_ && claim_.state() == NodeClaim::State::holding;
  }

  void take(const Message& message) {
    if (message.topic == claim_.life_topic() || message.topic == claim_.claim_topic()) {
      const bool was_refused = claim_.state() == NodeClaim::State::refused;
      claim_.take(message, std::chrono::steady_clock::now());
      if (claim_.state() == NodeClaim::State::refused && !was_refused) report_refusal();
      pump_claim();
      return;
    }
    if (!holds_node()) return;
    for (const auto& service : services_) {
      if (service->take(message)) return;
    }
  }

  void take_of_values(const Message& message) {
    if (message.topic != claim_.life_topic()) return;
    value_claim_.take(message);
    pump_values();
  }

  void set_values_connected(bool is_connected) {
    if (is_connected) {
      value_claim_.connected();
    } else {
      value_claim_.disconnected();
    }
    resume_values();
  }

  void report_refusal() {
    const std::string reason = "another gateway serves " + file_.site + "/" + file_.node + " at " +
                               carrier_.url() + ": " + claim_.holder();
    log_(LogLevel::error, reason);
    if (refused_) refused_(reason);
  }

  /// The claim first: while it is not decided nothing else is published.
  void pump_claim() {
    if (!is_connected_) return;
    const bool had_node = holds_node();
    while (const auto message = claim_.next(std::chrono::steady_clock::now())) {
      outbox_.add(*message);
    }
    if (!had_node && holds_node()) {
      for (const auto& service : services_) service->broker_connected();
    }
    pump_values();
    pump();
  }

  void pump() {
    if (!is_connected_) return;
    if (!outbox_.pump(carrier_, [this](const Message& message) { refuse(message); })) return;
    if (!holds_node()) return;
    for (const auto& service : services_) {
      if (!service->pump(carrier_)) return;
    }
  }

  void pump_values() {
    if (value_claim_.update()) wires_.publish_again();
    if (!value_claim_.allows() || ends_ || !values_have_room_) return;
    values_have_room_ = wires_.pump(values_, ExportedWires::Clock::now());
  }

  void resume_values() {
    values_have_room_ = true;
    pump_values();
  }

  /// An answer that is too large is answered with that.
  void refuse(const Message& message) {
    log_(LogLevel::error, message.topic + ": too large for the broker");
    if (message.correlation.empty() || message.payload.empty()) return;
    Message answer{message.topic, {}};
    answer.correlation = message.correlation;
    set_error(answer,
              std::make_exception_ptr(Error(ErrorCode::buffer_limit_violation,
                                            "the answer is too large for the broker")),
              "gateway");
    outbox_.add(std::move(answer));
  }

  void tick() {
    const std::int64_t jump = watch_.take_jump(std::chrono::steady_clock::now(), wall_time());
    if (jump != 0) {
      log_(LogLevel::warning,
           "the system's clock was set by " + std::to_string(jump / 1'000'000) + " ms");
      for (const auto& service : services_) service->clock_was_set(jump);
    }
    for (const auto& service : services_) service->tick();
    if (value_claim_.wants_life(ValueClaim::Clock::now())) claim_.repeat_life();
    pump_claim();
    resume_values();
  }

  ExportFile file_;
  Carrier& carrier_;  // for messages
  Carrier& values_;
  Log log_;
  Refused refused_;
  NodeClaim claim_;
  ValueClaim value_claim_{claim_};
  ClockWatch watch_{std::chrono::steady_clock::now(), wall_time()};
  Node node_;
  Outbox outbox_;
  ExportedWires wires_;
  std::unique_ptr<Worker> worker_;
  ValueHandler value_handler_;
  std::vector<std::shared_ptr<ServiceExporter>> services_;
  bool is_connected_ = false;
  bool values_have_room_ = true;
  bool ends_ = false;
  std::set<std::string> refusals_;  // topics that were reported for this connection
  std::string reason_;              // why it is not connected, as was reported
};

Exporter::Exporter(ExportFile file, const Carriers& carriers, Log log, Refused refused)
    : core_(std::make_unique<Core>(std::move(file), carriers, std::move(log), std::move(refused))) {
  core_->start();
}

Exporter::~Exporter() { core_->stop(); }

}  // namespace rr::gateway
