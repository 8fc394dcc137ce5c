// SPDX-License-Identifier: Apache-2.0
#include "gateway/exporter.hpp"

#include <utility>

#include "gateway/elements.hpp"
#include "gateway/properties.hpp"
#include "gateway/service_exporter.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::milliseconds export_tick{20};
constexpr std::chrono::seconds stream_tick{1};
constexpr std::chrono::minutes left_idle{10};

Message life(const ExportFile& file, std::string_view state) {
  Message message{node_topic(file.site, file.node) + "/$life", bytes_of(state)};
  message.retained = true;
  return message;
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
      window_(folder_ + "/$calls", {}, wall_time()) {}

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
  session_ = RobotSession::open(node, options_.url, options_.login, std::move(listener));
}

std::vector<std::string> ServiceExporter::filters() const {
  std::vector<std::string> all;
  for (const Verb verb : all_verbs) all.push_back(request_filter(address_, verb));
  return all;
}

bool ServiceExporter::pump(Carrier& carrier) {
  for (const auto& [topic, wire] : wires_) {
    if (!pump_wire(*wire, carrier)) return false;
  }
  for (auto& [topic, stream] : streams_) {
    while (const auto message = stream.writer->next()) {
      const Published result = carrier.publish(*message);
      stream.writer->done(result);
      if (result == Published::later) return false;
    }
  }
  return true;
}

void ServiceExporter::tick() {
  const auto now = std::chrono::steady_clock::now();
  window_.forget_old(wall_time());
  generators_.end_idle(now, left_idle);
  endpoints_.close_idle(now, left_idle);
  for (auto& [topic, stream] : streams_) {
    if (now - stream.ticked < stream_tick) continue;
    stream.ticked = now;
    stream.writer->tick(now, wall_time());
  }
}

/// All of it, behind a pointer so that the handler's address stays.
class Exporter::Core final : public CarrierHandler {
 public:
  Core(ExportFile file, Carrier& carrier, Log log)
      : file_(std::move(file)),
        carrier_(carrier),
        log_(std::move(log)),
        worker_(std::make_unique<Worker>(export_tick, [this] { tick(); })) {
    for (ExportedServiceOptions& options : file_.services) add(options);
  }

  void start() {
    worker_->start();
    worker_->post([this] {
      outbox_.add(life(file_, "up"));
      for (const auto& service : services_) service->connect(node_);
    });
    carrier_.start(*this, life(file_, "lost"));
  }

  void stop() {
    carrier_.stop(life(file_, "ended"));
    worker_->stop();
    services_.clear();
  }

  void on_message(Message message) override {
    if (!worker_->has_room()) return;
    worker_->post([this, message = std::move(message)] {
      for (const auto& service : services_) {
        if (service->take(message)) return;
      }
    });
  }
  void on_connected() override {
    worker_->post([this] {
      is_connected_ = true;
      reason_.clear();
      log_(LogLevel::info, "connected to " + carrier_.url());
      outbox_.add(life(file_, "up"));
      for (const auto& service : services_) service->broker_connected();
      pump();
    });
  }
  void on_disconnected(const std::string& reason) override {
    worker_->post([this, reason] {
      is_connected_ = false;
      outbox_.clear();
      if (std::exchange(reason_, reason) != reason) log_(LogLevel::warning, reason);
    });
  }
  void on_room() override {
    worker_->post([this] { pump(); });
  }
  void on_refused(const std::string& what) override {
    log_(LogLevel::error, "the broker has refused " + what);
  }

 private:
  void add(ExportedServiceOptions& options) {
    ServiceAddress address{file_.site, file_.node, options.name};
    const std::string folder = file_.state_folder + "/" + options.name;
    services_.push_back(std::make_shared<ServiceExporter>(
        std::move(address), options, folder,
        ServiceExporter::Shared{*worker_, outbox_, log_, [this] { pump(); }}));
    for (const std::string& filter : services_.back()->filters()) carrier_.subscribe(filter);
  }

  void pump() {
    if (!is_connected_) return;
    if (!outbox_.pump(carrier_, [this](const Message& message) { refuse(message); })) return;
    for (const auto& service : services_) {
      if (!service->pump(carrier_)) return;
    }
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
    for (const auto& service : services_) service->tick();
    pump();
  }

  ExportFile file_;
  Carrier& carrier_;
  Log log_;
  Node node_;
  Outbox outbox_;
  std::unique_ptr<Worker> worker_;
  std::vector<std::shared_ptr<ServiceExporter>> services_;
  bool is_connected_ = false;
  std::string reason_;  // why it is not connected, as was reported
};

Exporter::Exporter(ExportFile file, Carrier& carrier, Log log)
    : core_(std::make_unique<Core>(std::move(file), carrier, std::move(log))) {
  core_->start();
}

Exporter::~Exporter() { core_->stop(); }

}  // namespace rr::gateway
