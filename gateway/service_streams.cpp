// SPDX-License-Identifier: Apache-2.0
// What a service sends by itself: definitions, life, wires, pipes and events.
#include <filesystem>
#include <set>
#include <utility>

#include "gateway/elements.hpp"
#include "gateway/fleet.hpp"
#include "gateway/properties.hpp"
#include "gateway/service_exporter.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using Clock = std::chrono::steady_clock;

/// As a folder is called: no separators of folders are in a path.
std::string folder_name(const std::string& path, const std::string& member) {
  return path.empty() ? member : path + "." + member;
}

}  // namespace

void ServiceExporter::robot_connected(const dynamic::Object& root) {
  ++connection_;
  trouble_.clear();
  // Waits for handlers that run, and these wait for this thread when it has much to do.
  shared_.worker.set_bounded(false);
  attached_.clear();
  shared_.worker.set_bounded(true);
  root_ = root;
  attached_topics_.clear();
  closed_members_.clear();
  unsure_.clear();
  try {
    publish_definitions(root);
  } catch (const Error& error) {
    shared_.log(LogLevel::error, options_.name + ": " + error.what());
    return;
  }
  retain(closed_.message(service_topic(address_) + "/$closed"));
  const auto attaching = announce_when_attached();
  for (const std::string& path : attached_paths()) attach_path(path, {.all = attaching});
}

std::set<std::string> ServiceExporter::attached_paths() const {
  std::set<std::string> paths;
  for (const ExportRule& rule : options_.rules) {
    const bool is_literal = rule.path.find('*') == std::string::npos;
    if (is_literal && (rule.access & reading) != 0 && rule.users.empty()) paths.insert(rule.path);
  }
  return paths;
}

// Readers of `up` may rely on it: packets and events of the robot are logged from now on.
std::shared_ptr<void> ServiceExporter::announce_when_attached() {
  const auto announce = [weak = Weak(shared_from_this()), connection = connection_](void*) {
    const Self self = weak.lock();
    if (!self) return;
    self->shared_.worker.post([weak, connection] {
      const Self exporter = weak.lock();
      if (!exporter || exporter->connection_ != connection) return;
      if (exporter->trouble_.empty()) exporter->publish_life("up", "");
    });
  };
  return {nullptr, announce};
}

void ServiceExporter::robot_disconnected(const std::string& reason) {
  if (std::exchange(trouble_, reason) == reason) return;
  shared_.log(LogLevel::warning, options_.name + ": " + reason);
  publish_life("down", reason);
}

void ServiceExporter::publish_life(std::string_view life, const std::string& reason) {
  Message message{service_topic(address_) + "/$life", bytes_of(life)};
  if (!reason.empty()) message.properties.emplace_back("reason", reason);
  retain(std::move(message));
}

void ServiceExporter::publish_definitions(const dynamic::Object& root) {
  const dynamic::Definitions definitions = root.types();
  const std::string topic = service_topic(address_) + "/$def";
  std::string names;
  for (const std::string& name : definitions.services()) {
    names += (names.empty() ? "" : ",") + name;
    retain({topic + "/" + name, bytes_of(definitions.text(name))});
  }
  const std::string& type = root.type_name();
  Bytes attributes = encode_attributes(session_->attributes());
  Message message{topic, bytes_of(definitions.text(type.substr(0, type.rfind('.'))))};
  message.properties = {
      {"object", type}, {"definitions", names}, {"attributes", attributes.empty() ? "0" : "1"}};
  retain({service_topic(address_) + "/$attributes", std::move(attributes)});
  retain(std::move(message));
}

// For people and their tools (gateway/fleet.hpp).
void ServiceExporter::publish_status() {
  std::map<std::string, StreamStatus> streams;
  const std::string base = service_topic(address_) + "/";
  for (const auto& [topic, stream] : streams_) {
    streams[topic.substr(base.size())] = stream.writer->status();
  }
  const std::string topic = base + "$streams";
  const auto known = retained_.find(topic);
  Message message{topic, bytes_of(status_text(streams))};
  if (known != retained_.end() ? known->second.payload != message.payload : !streams.empty()) {
    retain(std::move(message));
  }
}

void ServiceExporter::retain(Message message) {
  message.retained = true;
  unpublished_.insert(message.topic);
  retained_[message.topic] = std::move(message);
  shared_.pump();
}

void ServiceExporter::broker_connected() {
  for (const auto& [topic, message] : retained_) unpublished_.insert(topic);
  for (auto& [topic, stream] : streams_) stream.writer->announce();
}

void ServiceExporter::attach_path(const std::string& path, const Attaching& attaching) {
  find_object(root_, path,
              [weak = Weak(shared_from_this()), path, attaching, connection = connection_](
                  const std::exception_ptr& error, const dynamic::Object& object) {
                const Self self = weak.lock();
                if (!self) return;
                self->shared_.worker.post([weak, path, attaching, error, object, connection] {
                  const Self exporter = weak.lock();
                  if (!exporter || exporter->connection_ != connection) return;
                  if (!error) {
                    exporter->attach_members(path, object, attaching);
                  } else {
                    exporter->shared_.log(LogLevel::warning,
                                          exporter->options_.name + ": `" + path +
                                              "` of the export file is not there");
                  }
                });
              });
}

void ServiceExporter::attach_members(const std::string& path, const dynamic::Object& object,
                                     const Attaching& attaching) {
  shared_.worker.set_bounded(false);  // as in robot_connected()
  attached_[path] = object;
  shared_.worker.set_bounded(true);
  for (const dynamic::MemberDescription& member : object.members()) {
    if (!attaching.members.empty() && !attaching.members.contains(member.name)) continue;
    const ExportRule* const rule = find_rule(options_, "", path, member.name, reading);
    if (rule == nullptr || (member.access & writeonly) != 0) continue;
    const bool is_stream = member.kind == MemberKind::pipe || member.kind == MemberKind::event;
    if (member.kind != MemberKind::wire && !is_stream) continue;
    if (!attached_topics_.insert(member_topic(address_, path, member.name)).second) continue;
    if (member.kind == MemberKind::wire) attach_wire(path, object, member, *rule, attaching);
    if (member.kind == MemberKind::pipe) attach_pipe(path, object, member, attaching);
    if (member.kind == MemberKind::event) attach_event(path, object, member);
  }
}

void ServiceExporter::attach_wire(const std::string& path, const dynamic::Object& object,
                                  const dynamic::MemberDescription& member, const ExportRule& rule,
                                  const Attaching& attaching) {
  const auto wire = shared_.wires.add(
      {member_topic(address_, path, member.name), member.type, rule.period, rule.lifespan});
  object.wire(member.name)
      .async_connect([weak = Weak(shared_from_this()), wire, attaching,
                      closed = when_closed(path, member.name)](const std::exception_ptr& error,
                                                               dynamic::WireConnection end) {
        if (error) {
          closed(error);
          return;
        }
        end.on_in([weak, wire](const dynamic::Value& value, const TimeSpec& time) {
             if (const Self self = weak.lock()) self->take_value(*wire, value, time);
           })
            .detach();
        end.on_closed([closed] { closed(nullptr); });
      });
}

// Of values that come faster than they are published only the newest counts.
void ServiceExporter::take_value(ExportedWires::Wire& wire, const dynamic::Value& value,
                                 const TimeSpec& time) {
  if (!ExportedWires::put(wire, value, time)) return;
  shared_.worker.post([weak = Weak(shared_from_this())] {
    if (const Self self = weak.lock()) self->shared_.pump_values();
  });
}

void ServiceExporter::attach_pipe(const std::string& path, const dynamic::Object& object,
                                  const dynamic::MemberDescription& member,
                                  const Attaching& attaching) {
  StreamExport* const stream = begin_stream(path, member.name);
  if (stream == nullptr) return;
  const std::vector<dynamic::ParameterDescription> one{{"value", member.type}};
  object.pipe(member.name)
      .async_connect([weak = Weak(shared_from_this()), stream, one, attaching,
                      closed = when_closed(path, member.name)](const std::exception_ptr& error,
                                                               dynamic::PipeEndpoint end) {
        if (error) {
          closed(error);
          return;
        }
        end.on_packet([weak, stream, one](const dynamic::Value& packet) {
             if (const Self self = weak.lock()) self->take_record(stream, one, {packet});
           })
            .detach();
        end.on_closed([closed] { closed(nullptr); });
      });
}

void ServiceExporter::attach_event(const std::string& path, const dynamic::Object& object,
                                   const dynamic::MemberDescription& member) {
  StreamExport* const stream = begin_stream(path, member.name);
  if (stream == nullptr) return;
  object
      .on_event(member.name,
                [weak = Weak(shared_from_this()), stream,
                 parameters = member.parameters](const dynamic::List& arguments) {
                  if (const Self self = weak.lock())
                    self->take_record(stream, parameters, arguments);
                })
      .detach();
}

// On a thread of the node, which waits while the disk is slower than the robot.
void ServiceExporter::take_record(StreamExport* stream,
                                  const std::vector<dynamic::ParameterDescription>& parameters,
                                  const dynamic::List& values) {
  shared_.worker.post_in_turn([weak = Weak(shared_from_this()), stream, parameters, values] {
    if (const Self self = weak.lock()) self->append(*stream, parameters, values);
  });
}

ServiceExporter::StreamExport* ServiceExporter::stream(const std::string& path,
                                                       const std::string& member, bool makes) {
  const std::string topic = member_topic(address_, path, member);
  const auto known = streams_.find(topic);
  if (known != streams_.end()) return &known->second;
  const std::string folder = folder_ + "/" + folder_name(path, member);
  if (!makes && !std::filesystem::exists(folder)) return nullptr;
  try {
    StreamExport stream{std::make_unique<StreamWriter>(
        topic, folder, gateway::LogLimits{.bytes = options_.log_bytes, .age = options_.log_age},
        options_.readers)};
    return &streams_.emplace(topic, std::move(stream)).first->second;
  } catch (const Error& error) {
    shared_.log(LogLevel::error, error.what());
    return nullptr;
  }
}

ServiceExporter::StreamExport* ServiceExporter::begin_stream(const std::string& path,
                                                             const std::string& member) {
  StreamExport* const found = stream(path, member, true);
  if (found != nullptr && found->writer->last() > 0) append_broken(*found);
  return found;
}

void ServiceExporter::append(StreamExport& stream,
                             const std::vector<dynamic::ParameterDescription>& parameters,
                             const dynamic::List& values) {
  try {
    stream.writer->append(RecordKind::data, type_text(parameters),
                          encode_arguments(parameters, values), wall_time(), Clock::now());
  } catch (const Error& error) {
    shared_.log(LogLevel::error, options_.name + ": a packet is lost: " + error.what());
  }
  shared_.pump();
}

void ServiceExporter::append_broken(StreamExport& stream) {
  try {
    stream.writer->append(RecordKind::broken, "", {}, wall_time(), Clock::now());
  } catch (const Error& error) {
    shared_.log(LogLevel::error, options_.name + ": " + error.what());
  }
  shared_.pump();
}

}  // namespace rr::gateway
