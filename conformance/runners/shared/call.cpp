// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/call.hpp"

#include <chrono>
#include <rr/locks.hpp>
#include <stdexcept>
#include <thread>

#include "conformance/runners/shared/node_settings.hpp"

namespace rr::conformance {
namespace {

constexpr std::chrono::seconds arrival_limit{2};

// What services answer to operations on a session; the runtime takes nothing else for success.
constexpr const char* done = "OK";

// Codes of the recorded client's notifications.
constexpr int client_closed = 1;
constexpr int path_released = 5;

Json raised(Binding& binding, const Error& error) {
  Json json = {{"code", static_cast<int>(error.code())},
               {"name", error.name()},
               {"message", error.message()}};
  if (!error.subname().empty()) json["subname"] = error.subname();
  if (!error.parameter().is_null()) json["param"] = binding.write(error.parameter());
  return json;
}

// An index as paths spell it: ASCII letters and digits as they are, every other byte with two
// digits.
std::string escaped(const std::string& index) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const char c : index) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (plain) {
      text += c;
    } else {
      text += {'%', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return text;
}

// `objref` or `objref[index]`, as a step asks for it.
std::string relative_path(const Json& step) {
  std::string member = step.at("member");
  if (!step.contains("index")) return member;
  const Json& index = step["index"];
  return member + "[" + escaped(index.is_string() ? index.get<std::string>() : index.dump()) + "]";
}

}  // namespace

void Arrivals::add(Json thing) {
  {
    const std::lock_guard lock(mutex_);
    things_.push_back(std::move(thing));
  }
  changed_.notify_all();
}

Json Arrivals::wait(std::size_t count) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, arrival_limit, [&] { return things_.size() >= count; });
  return std::exchange(things_, Json::array());
}

void Arrivals::clear() {
  const std::lock_guard lock(mutex_);
  things_ = Json::array();
}

Json CallingNode::answer(const Json& request) {
  const std::string what = request.at("do");
  if (what == "start") {
    stop();
    arrivals_.clear();
    node_ = std::make_unique<Node>(node_options(request));
    binding_.prepare(*node_);
    return {{"done", true}};
  }
  if (what == "stop_node") {
    stop();
    return {{"done", true}};
  }
  try {
    return {{"result", play(request.at("step"))}};
  } catch (const Error& error) {
    return {{"raised", raised(binding_, error)}};
  } catch (const NotSupported& reason) {
    return {{"unsupported", reason.what()}};
  }
}

// The node first: a client that ends by itself waits for the service to answer.
void CallingNode::stop() {
  subscriptions_.clear();
  if (node_) node_->shutdown();
  pipes_.clear();
  wires_.clear();
  generators_.clear();
  objects_.clear();
  clients_.clear();
  node_.reset();
}

Json CallingNode::play(const Json& step) {
  const std::string operation = step.at("op");
  if (operation == "connect") return connect(step);
  if (operation == "wait") return arrivals_.wait(step.at("count").get<std::size_t>());
  if (operation == "drain") {
    arrivals_.clear();
    return nullptr;
  }
  if (operation == "disconnect") {
    clients_.at(step.at("obj").get<std::string>())->close();
    return nullptr;
  }
  if (operation == "get") return object(step).caller->get(step.at("member").get<std::string>());
  if (operation == "set") {
    object(step).caller->set(step.at("member").get<std::string>(), step.at("value"));
    return nullptr;
  }
  if (operation == "call") {
    return object(step).caller->call(step.at("member").get<std::string>(), step.at("args"));
  }
  if (operation == "objref") return find(step);
  if (operation == "find_object_type") return find_object_type(step);
  if (operation == "listen") return listen(step);
  if (operation == "attributes") return attributes(step);
  if (operation == "local_services") return local_services(step);
  if (operation == "callback_set") return set_callback(step);
  if (operation.starts_with("pipe_")) return play_pipe(operation, step);
  if (operation.starts_with("wire_")) return play_wire(operation, step);
  if (operation.starts_with("mem_")) return play_memory(operation, step);
  if (operation.starts_with("gen_")) return play_generator(operation, step);
  if (operation == "sleep") {
    std::this_thread::sleep_for(std::chrono::milliseconds(step.at("ms").get<int>()));
    return nullptr;
  }
  return play_session(operation, step);
}

Json CallingNode::play_session(const std::string& operation, const Json& step) {
  if (operation == "authenticate") {
    authenticate(step);
    return done;
  }
  if (operation == "lock") {
    lock(*object(step).held.stub,
         step.value("client", false) ? LockOwner::session : LockOwner::user);
    return done;
  }
  if (operation == "unlock") {
    unlock(*object(step).held.stub);
    return done;
  }
  if (operation == "monitor_enter") {
    enter_monitor(*object(step).held.stub,
                  std::chrono::milliseconds(step.at("timeout").get<int>()));
    return nullptr;
  }
  if (operation == "monitor_exit") {
    exit_monitor(*object(step).held.stub);
    return nullptr;
  }
  throw NotSupported("this runner cannot do " + operation);
}

CallingNode::Object& CallingNode::object(const Json& step) {
  const auto found = objects_.find(step.at("obj").get<std::string>());
  if (found == objects_.end()) throw std::runtime_error("there is no object " + step["obj"].dump());
  return found->second;
}

Json CallingNode::keep(const std::string& name, const std::string& client, Held held) {
  auto caller = binding_.caller(held);
  const Json type = {{"rrtype", held.type}};
  objects_[name] = {std::move(held), std::move(caller), client};
  return type;
}

std::map<std::string, VarValue> CallingNode::credentials(const Json& step) const {
  std::map<std::string, VarValue> values;
  const Json given = step.value("credentials", Json::object());
  for (const auto& [key, value] : given.items()) {
    values[key] = binding_.read(value);
  }
  return values;
}

void CallingNode::authenticate(const Json& step) {
  clients_.at(object(step).client)
      ->authenticate(step.at("username").get<std::string>(), credentials(step));
}

Json CallingNode::connect(const Json& step) {
  const std::string name = step.at("as");
  ConnectOptions options;
  options.username = step.value("username", "");
  options.object_type = step.value("objecttype", "");
  options.credentials = credentials(step);
  options.on_closed = [this, name](const Error&) {
    arrivals_.add({{"event_type", client_closed}, {"service", name}});
  };
  options.on_path_released = [this, name](const std::string& path) {
    arrivals_.add({{"event_type", path_released}, {"path", path}, {"service", name}});
  };
  auto [client, root] =
      binding_.connect(*node_, step.at("url").get<std::string>(), std::move(options));
  clients_.insert_or_assign(name, std::move(client));
  return keep(name, name, std::move(root));
}

Json CallingNode::find(const Json& step) {
  Object& parent = object(step);
  Held held =
      parent.caller->objref(step.at("member").get<std::string>(), step.value("index", Json()));
  return keep(step.at("as"), parent.client, std::move(held));
}

Json CallingNode::find_object_type(const Json& step) {
  const Object& parent = object(step);
  return clients_.at(parent.client)
      ->find_object_type(parent.held.stub->rr_path() + "." + relative_path(step));
}

Json CallingNode::listen(const Json& step) {
  const std::string member = step.at("member");
  const std::string name = step.value("as", member);
  subscriptions_.push_back(object(step).caller->listen(member, [this, name](const Json& arguments) {
    arrivals_.add({{"event", name}, {"args", arguments}});
  }));
  return nullptr;
}

Json CallingNode::attributes(const Json& step) {
  Json result = Json::object();
  for (const auto& [name, value] : clients_.at(object(step).client)->attributes()) {
    result[name] = binding_.write(value);
  }
  return result;
}

// The object is an ordinary one of the definition RobotRaconteurServiceIndex.
Json CallingNode::local_services(const Json& step) {
  Json result = Json::array();
  for (const Json& item : object(step).caller->call("GetLocalNodeServices", Json::array())) {
    result.push_back({{"index", item.at(0)},
                      {"name", item.at(1).at("Name")},
                      {"type", item.at(1).at("RootObjectType")}});
  }
  return result;
}

}  // namespace rr::conformance
