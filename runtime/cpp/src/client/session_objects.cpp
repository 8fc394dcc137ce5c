// SPDX-License-Identifier: Apache-2.0
// The objects of a service as a client sees them: stubs by path, and what the service sends
// unasked.
#include <algorithm>
#include <unordered_set>
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/client/definition_reader.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/client/wire_end.hpp"
#include "runtime/cpp/src/endpoint/arguments.hpp"
#include "runtime/cpp/src/endpoint/client_version.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/endpoint/subscription.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr {
namespace {

// Types that one object has: what a service says beyond it is not looked at.
constexpr std::size_t most_types = 4096;
// How often the type of an object is asked for when the object is released each time.
constexpr int most_lookups = 8;

std::string service_of(const std::string& type) { return type.substr(0, type.rfind('.')); }

Error released_while_looked_up(const std::string& path) {
  return {ErrorCode::service_error, "`" + path + "` was released each time it was looked up"};
}

}  // namespace

// Types that `type` implements, directly or not, itself first: as the compiled definitions say, or
// the texts that the service has sent.
std::vector<std::string> Session::implemented(const std::string& type) const {
  std::vector<std::string> found = {type};
  std::unordered_set<std::string> names = {type};
  const MutexLock lock(mutex_);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string name = found[i];  // the vector grows
    const std::string service = service_of(name);
    const auto add = [&](std::string other) {
      if (other.find('.') == std::string::npos) other = service + "." + other;
      if (found.size() < most_types && names.insert(other).second) {
        found.push_back(std::move(other));
      }
    };
    if (const ObjectType* const known = types()->find_object(name)) {
      for (const std::string_view other : known->implements) add(std::string(other));
    }
    if (name.size() <= service.size()) continue;
    const auto* const others =
        texts_.implements(service, std::string_view(name).substr(service.size() + 1));
    if (others == nullptr) continue;
    for (const std::string& other : *others) add(other);
  }
  return found;
}

// The same with what the service has told besides.
std::vector<std::string> Session::all_types(const std::string& told,
                                            const std::vector<std::string>& implements) const {
  std::vector<std::string> types = implemented(told);
  for (const std::string& other : implements) {
    if (types.size() >= most_types) break;
    types.push_back(other.find('.') == std::string::npos ? service_of(told) + "." + other : other);
  }
  return types;
}

// The stub of an object of which the service has told the type, and perhaps what it implements. Of
// all its types that this program knows the most derived one is taken.
std::shared_ptr<Stub> Session::make_stub(const std::string& told, const std::string& path,
                                         std::string_view wanted,
                                         const std::vector<std::string>& implements,
                                         const ObjectType* preferred) {
  if (options_.definition_reader) options_.definition_reader->read(definitions());
  const std::vector<std::string> names = all_types(told, implements);
  if (!wanted.empty() && std::find(names.begin(), names.end(), wanted) == names.end()) {
    throw Error(ErrorCode::service_error,
                "Invalid object type: `" + path + "` is a `" + told + "`");
  }
  const ObjectType* known = nullptr;
  for (const std::string& type : names) {
    // What the caller has is taken before what is known by the same name.
    const bool is_preferred = preferred != nullptr && preferred->name == type;
    const ObjectType* const found = is_preferred ? preferred : types()->find_object(type);
    if (found == nullptr || found->make_stub == nullptr) continue;
    known = found;
    break;
  }
  if (known == nullptr) {
    throw Error(ErrorCode::service_error,
                "Invalid object type: this program does not know `" + told + "`");
  }
  std::shared_ptr<Stub> stub = known->make_stub();
  stub->rr_session_ = shared_from_this();
  stub->rr_path_ = path;
  stub->rr_take_object_type(*known);
  return stub;
}

std::shared_ptr<Stub> Session::make_stub_beside(const Stub& stub, const ObjectType& type) {
  std::shared_ptr<Stub> beside = type.make_stub();
  beside->rr_session_ = shared_from_this();
  beside->rr_path_ = stub.rr_path();
  beside->rr_timeout_ = stub.rr_timeout();
  beside->rr_take_object_type(type);
  return beside;
}

std::vector<std::string> Session::root_types() const {
  return all_types(object_type_, object_implements_);
}

// A type's definition may not have come with the service's own (07, section 5).
void Session::pull_type(const std::string& type, Milliseconds timeout) {
  const std::string service = service_of(type);
  if (service == type || service.empty()) return;
  {
    const MutexLock lock(mutex_);
    if (texts_.contains(service) && !texts_.missing_import()) return;
  }
  const Patience patience = patience_for(timeout);
  pull_definition(service, patience);
  pull_imports(patience);
  compare_definitions(*types());
}

std::shared_ptr<Stub> Session::find(const std::string& path, std::string_view wanted,
                                    Milliseconds timeout) {
  for (int asked = 0; asked < most_lookups; ++asked) {
    if (auto stub = stubs_.find(path)) return stub;
    const client::StubCache::Lookup lookup(stubs_, path);
    const std::string told = ask_object_type(path, timeout);
    pull_type(told, timeout);
    if (auto stub = keep_found(lookup, told, wanted)) return stub;
  }
  throw released_while_looked_up(path);
}

// Null when the object was released since the lookup began.
std::shared_ptr<Stub> Session::keep_found(const client::StubCache::Lookup& lookup,
                                          const std::string& told, std::string_view wanted) {
  return stubs_.keep(lookup, make_stub(told, lookup.path(), wanted, {}));
}

void Session::release_path(std::string_view path, std::uint64_t notice) {
  std::function<void(const std::string&)> notify;
  {
    const MutexLock lock(mutex_);
    notify = on_path_released_;
  }
  channel::DeferredCallbacks deferred;
  const auto is_meant = [notice](const WireEnd::State& end) {
    return static_cast<const client::ClientWireEnd&>(end).is_meant_by(notice);
  };
  for (const auto& end : wires_.take_below(path, is_meant)) end->finish(deferred);
  post(std::move(deferred));
  pipes_.release(path, notice);
  if (notify) notify(std::string(path));
}

bool Session::take_packet(const Message& message, const Entry& entry, const MemoryRef& owner,
                          channel::DeferredCallbacks& deferred) {
  const auto end = wires_.find(entry.service_path, entry.member);
  if (!end) return false;
  if (entry.type == EntryType::wire_packet) {
    end->take(message, entry, owner, *types(), deferred);
  } else {
    wires_.remove(*end);
    end->finish(deferred);
  }
  return true;
}

void Session::add_handler(const std::shared_ptr<client::EventSubscription>& handler) {
  std::vector<std::shared_ptr<client::EventSubscription>> removed;  // goes when the lock has
  const MutexLock lock(mutex_);
  std::erase_if(handlers_, [&](const auto& item) {
    if (!item->is_connected()) removed.push_back(item);
    return !item->is_connected();
  });
  handlers_.push_back(handler);
}

void Session::forget(const Stub& stub) {
  std::vector<std::shared_ptr<client::EventSubscription>> removed;
  {
    const MutexLock lock(mutex_);
    std::erase_if(handlers_, [&](const auto& item) {
      if (item->stub == &stub) removed.push_back(item);
      return item->stub == &stub;
    });
  }
  stubs_.forget(stub);
  for (const auto& handler : removed) handler->disconnect();
  callbacks_.forget(stub);
}

// An answer that comes behind a release is read before the release is handled: what was there is
// not found again from here on.
void Session::foresee(const Message& message) {
  notices_.foresee(message);
  EntryReader entries(message);
  for (Entry entry; entries.next(entry);) {
    if (entry.type == EntryType::service_path_released_req) {
      stubs_.release(entry.service_path, service_);
    }
  }
}

[[gnu::hot]] void Session::handle(const Message& message, const Entry& first,
                                  const MemoryRef& owner) {
  const channel::LogScope scope(core_->options(), *connection_, connection_->own_endpoint());
  const auto handle_one = [&](const Entry& entry) {
    endpoint::call_user_code(*core_, "a handler", [&] { handle_entry(message, entry, owner); });
  };
  if (message.entry_count == 1) {
    handle_one(first);
    return;
  }
  EntryReader entries(message);
  for (Entry entry; entries.next(entry);) handle_one(entry);
}

[[gnu::hot]] void Session::handle_entry(const Message& message, const Entry& entry,
                                        const MemoryRef& owner) {
  if (is_given_up_) return;
  if (static_cast<ErrorCode>(entry.error) == ErrorCode::invalid_endpoint) {
    close();
    return;
  }
  const std::uint64_t notice = client::Notices::is_one(entry) ? notices_.next() : 0;
  switch (entry.type) {
    case EntryType::service_closed:
      give_up(Error(ErrorCode::service_not_found, "the service was closed"));
      break;
    case EntryType::service_path_released_req:
      release_path(entry.service_path, notice);
      break;
    case EntryType::event_req:
      handle_event(message, entry, owner);
      break;
    case EntryType::callback_call_req:
      answer_callback(message, entry, owner);
      break;
    case EntryType::wire_packet:
    case EntryType::wire_closed: {  // one of several entries
      channel::DeferredCallbacks deferred;
      take_packet(message, entry, owner, deferred);
      post(std::move(deferred));
      break;
    }
    case EntryType::pipe_packet:
      pipes_.take_packets(message, entry, owner);
      break;
    case EntryType::pipe_packet_ret:
      pipes_.take_acknowledgements(message, entry);
      break;
    case EntryType::pipe_closed:
      pipes_.take_closed(message, entry, notice);
      break;
    default:
      if (static_cast<std::uint16_t>(entry.type) % 2 != 0) answer_request(message, entry);
      break;
  }
}

void Session::handle_event(const Message& message, const Entry& entry, const MemoryRef& owner) {
  std::vector<std::shared_ptr<client::EventSubscription>> handlers;
  {
    const MutexLock lock(mutex_);
    for (const auto& handler : handlers_) {
      if (handler->path == entry.service_path && handler->member->name == entry.member) {
        handlers.push_back(handler);
      }
    }
  }
  const Arguments::Source source{message, entry, owner, *types()};
  for (const auto& handler : handlers) {
    endpoint::call_user_code(*core_, "a handler of the event", entry.member,
                             [&] { handler->call(Arguments(source)); });
  }
}

// What a node may ask of any other; what is not served here is refused (07, sections 2 and 4).
void Session::answer_request(const Message& message, const Entry& entry) {
  Writer& writer = channel::thread_writer();
  writer.reset(connection_->version());
  switch (entry.type) {
    case EntryType::get_node_info:
      endpoint::write_empty_answer(writer, entry);
      break;
    case EntryType::node_check_capability:
    case EntryType::endpoint_check_capability:
      endpoint::write_capability_answer(writer, entry);
      break;
    default:
      if (static_cast<std::uint16_t>(entry.type) >= 500) return;  // packets that nobody wants
      endpoint::write_error_answer(writer, entry,
                                   Error(ErrorCode::protocol_error, "Invalid Special Operation"));
      break;
  }
  send_answer(writer, message, entry, true);
}

// Ends the message of an answer with its header. As a reply only with the dispatch turn.
void Session::send_answer(Writer& writer, const Message& message, const Entry& entry, bool is_reply,
                          bool is_urgent) {
  MessageHeader header{.sender_node = core_->options().id,
                       .receiver_node = message.sender_node,
                       .sender_endpoint = message.receiver_endpoint,
                       .receiver_endpoint = message.sender_endpoint,
                       .routing = false};
  if (static_cast<std::uint16_t>(entry.type) < 500) {
    header.sender_name = core_->options().name;
    header.receiver_name = message.sender_name;
    header.routing = true;
  } else {
    const MutexLock lock(mutex_);
    header.message_id = next_message_id_++;
  }
  writer.message(header, 1);
  const channel::Priority priority = endpoint::priority_of(entry.type, is_urgent);
  if (is_reply) {
    connection_->reply(writer, priority);
  } else {
    connection_->send(writer, channel::coarse_now(), priority);
  }
}

// Asynchronous search: the answer brings the type, and the rest may ask more, on a thread of the
// node.
class Session::Search final : public Completion, public std::enable_shared_from_this<Search> {
 public:
  Search(std::shared_ptr<Session> session, std::string path, std::string wanted,
         Milliseconds timeout, std::shared_ptr<Completion> completion)
      : session_(std::move(session)),
        path_(std::move(path)),
        wanted_(std::move(wanted)),
        timeout_(timeout),
        completion_(std::move(completion)) {}

  static void start(const std::shared_ptr<Search>& search);

  void* result() override { return &told_; }
  void succeed() override {
    std::shared_ptr<Stub> stub;
    try {
      session_->pull_type(told_, timeout_);
      stub = session_->keep_found(*lookup_, told_, wanted_);
      if (!stub && asked_ == most_lookups) throw released_while_looked_up(path_);
    } catch (...) {
      fail(std::current_exception());
      return;
    }
    if (!stub) {
      start(shared_from_this());
      return;
    }
    *static_cast<std::shared_ptr<Stub>*>(completion_->result()) = std::move(stub);
    completion_->succeed();
  }
  void fail(std::exception_ptr error) override { completion_->fail(std::move(error)); }

 private:
  const std::shared_ptr<Session> session_;
  const std::string path_;
  const std::string wanted_;
  const Milliseconds timeout_;
  const std::shared_ptr<Completion> completion_;
  std::optional<client::StubCache::Lookup> lookup_;
  int asked_ = 0;
  std::string told_;
};

void Session::Search::start(const std::shared_ptr<Search>& search) {
  const std::string version(endpoint::own_version);
  const Parameter parameter{"clientversion", &type_of<std::string>};
  const void* const value = &version;
  Session& session = *search->session_;
  search->lookup_.emplace(session.stubs_, search->path_);
  ++search->asked_;
  session.start({EntryType::object_type_name, search->path_, {}, {&parameter, 1}, &value},
                {"objecttype", &type_of<std::string>, &search->told_}, search->timeout_, search);
}

void Session::start_find(std::string path, std::string wanted, Milliseconds timeout,
                         std::shared_ptr<Completion> completion) {
  if (auto stub = stubs_.find(path)) {
    *static_cast<std::shared_ptr<Stub>*>(completion->result()) = std::move(stub);
    post({[completion = std::move(completion)] { completion->succeed(); }});
    return;
  }
  Search::start(std::make_shared<Search>(shared_from_this(), std::move(path), std::move(wanted),
                                         timeout, std::move(completion)));
}

}  // namespace rr
