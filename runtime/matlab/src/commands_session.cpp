// SPDX-License-Identifier: Apache-2.0
// Connecting, and what concerns a session as a whole.
#include "rr/error.hpp"
#include "runtime/matlab/src/credentials.hpp"
#include "runtime/matlab/src/listeners.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {
namespace {

// Waits for something that happens on another thread, so that Ctrl-C ends the waiting at least.
dynamic::Client wait_connected(Runtime& runtime, const std::string& url, ConnectOptions options) {
  struct Answer {
    std::atomic<bool> has_come{false};
    std::exception_ptr error;
    dynamic::Client client;
  };
  auto answer = std::make_shared<Answer>();
  dynamic::async_connect(
      runtime.node(), url, std::move(options),
      [answer, queue = runtime.queue()](std::exception_ptr error, dynamic::Client client) {
        answer->error = std::move(error);
        answer->client = std::move(client);
        answer->has_come = true;
        queue->wake();
      });
  runtime.wait_until([&] { return answer->has_come.load(); }, std::chrono::milliseconds::max());
  if (answer->error) std::rethrow_exception(answer->error);
  return std::move(answer->client);
}

const dynamic::Client& own_client(const ObjectHandle& object) {
  const dynamic::Client& client = object.connection()->client();
  if (!client.rr_session()) {
    throw Error(ErrorCode::invalid_operation, "the client belongs to a subscription");
  }
  return client;
}

// The arguments of who listens to a session.
std::function<std::vector<mxArray*>()> session_news(const char* what, const std::string& detail) {
  return [what, detail]() -> std::vector<mxArray*> { return {make_text(what), make_text(detail)}; };
}

// connect(urls [, username, credentials, object type]): number of the root object; of several URLs
// the first that answers
void connect(Runtime& runtime, Call& call) {
  ConnectOptions options;
  if (call.has(1)) options.username = call.text(1);
  if (call.has(2)) options.credentials = read_credentials(call[2]);
  if (call.has(3)) options.object_type = call.text(3);
  options.allow_clear_credentials = runtime.allow_clear_credentials;
  const auto listeners = std::make_shared<Listeners>(runtime);
  options.on_closed = [listeners](const Error& why) {
    Listeners::tell_last(listeners, session_news("ClientClosed", why.message()));
  };
  options.on_path_released = [listeners](const std::string& path) {
    Listeners::tell(listeners, session_news("ServicePathReleased", path));
  };
  const std::vector<std::string> urls = read_texts(call[0]);
  if (urls.empty()) throw Error(ErrorCode::invalid_argument, "there is no URL");
  for (std::size_t i = 0;; ++i) {
    try {
      auto client = wait_connected(runtime, urls[i], options);
      const dynamic::Object root = client.root();
      auto connection = std::make_shared<Connection>(runtime, std::move(client), listeners);
      call.give(give_object(runtime, std::move(connection), root));
      return;
    } catch (const Error& error) {
      if (i + 1 == urls.size() || error.code() == ErrorCode::operation_cancelled) throw;
    }
  }
}

// disconnect(object)
void disconnect(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  runtime.current.reset();
  object->connection()->close();
}

// session_listen(object, function): number of the listener, function(what, detail)
void session_listen(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const auto& connection = object->connection();
  if (!own_client(*object).is_open()) {
    throw Error(ErrorCode::invalid_operation, "the session has ended");
  }
  // Not one of the connection's: it hears of its end, too.
  const std::uint64_t number =
      runtime.functions().add({.function = Kept(need_function(call[1], "listener")),
                               .parameter = {},
                               .member = {},
                               .connection = connection,
                               .subscription = nullptr});
  connection->session_listeners->add(number);
  call.give(make_number(number));
}

// As paths spell an index: other bytes than letters and digits of ASCII by two digits (07,
// section 3).
std::string spelled_index(const std::string& index) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string spelled;
  for (const char c : index) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) != 0) {
      spelled += c;
    } else {
      spelled += {'%', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return spelled;
}

// Waits as wait_connected() does: a service of this interpreter's answers on this thread.
std::string ask_object_type(Runtime& runtime, const dynamic::Client& client,
                            const std::string& path) {
  struct Answer {
    std::atomic<bool> has_come{false};
    std::exception_ptr error;
    std::string type;
  };
  const auto answer = std::make_shared<Answer>();
  runtime.node().run_aside([answer, path, session = client.rr_session(), queue = runtime.queue()] {
    ClientBase asking(session);
    try {
      answer->type = asking.find_object_type(path);
    } catch (const Error&) {
      answer->error = std::current_exception();
    }
    (void)asking.rr_release();  // it is not to end with this
    answer->has_come = true;
    queue->wake();
  });
  runtime.wait_until([&] { return answer->has_come.load(); }, std::chrono::milliseconds::max());
  if (answer->error) std::rethrow_exception(answer->error);
  return answer->type;
}

// find_object_type(object, objref [, index]): the type of the object there, as the service says
void find_object_type(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const auto& client = own_client(*object);
  const Resolved& member = object->resolve(call.text(1));
  std::string path = object->object().path() + "." + member.member.name;
  const dynamic::Value index = read_index(member, call.has(2) ? call[2] : nullptr);
  if (index.kind() == dynamic::Kind::text) {
    path += "[" + spelled_index(index.text()) + "]";
  } else if (!index.is_null()) {
    path += "[" + spelled_index(std::to_string(index.as<std::int32_t>())) + "]";
  }
  call.give(make_text(ask_object_type(runtime, client, path)));
}

// close(number): gives an object, wire, ... back
void close(Runtime& runtime, Call& call) {
  runtime.current.reset();
  runtime.handles().remove(call.handle(0));
}

// attributes(object): containers.Map of plain values, and of values with their types, as the
// service gave them when connecting
void attributes(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  Connection& connection = *object->connection();
  std::map<std::string, mxArray*> items;
  std::map<std::string, mxArray*> varvalues;
  for (const auto& [name, value] : own_client(*object).attributes()) {
    items.emplace(name, plain_to_mex(value));
    varvalues.emplace(name, varvalue_to_mex(value, connection));
  }
  call.give(make_map(items));
  call.give(make_map(varvalues));
}

// authenticate(object, username, credentials)
void authenticate(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const std::string username = call.text(1);
  const auto credentials = read_credentials(call[2]);
  runtime.call_directly(
      [&] { object->connection()->client().authenticate(username, credentials); });
}

// logout(object)
void logout(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  runtime.call_directly([&] { object->connection()->client().logout(); });
}

// service(object): struct with node_id, node_name, object_type
void service(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const auto& client = own_client(*object);
  call.give(make_struct({{"node_id", make_text(client.remote_node().text())},
                         {"node_name", make_text(client.remote_name())},
                         {"object_type", make_text(client.object_type())}}));
}

}  // namespace

std::map<std::string, VarValue> read_varvalues(const mxArray* given, const std::string& subject,
                                               const std::string& expected) {
  std::map<std::string, VarValue> values;
  if (is_null(given)) return values;
  const dynamic::Value value = as_subject(subject, [&] { return plain_from_mex(given); });
  if (value.kind() != dynamic::Kind::string_map) {
    throw Error(ErrorCode::data_type_mismatch,
                subject + ": expected " + expected + ", got " + described(given));
  }
  for (const auto& [name, item] : value.string_map()) {
    values.emplace(name, dynamic::to_varvalue(item));
  }
  return values;
}

std::map<std::string, VarValue> read_credentials(const mxArray* given) {
  if (!is_null(given) && (is_text(given) || mxIsClass(given, "string"))) {
    return {{"password", dynamic::to_varvalue(dynamic::Value(
                             as_subject("credentials", [&] { return read_text(given); })))}};
  }
  return read_varvalues(given, "credentials", "a password, a containers.Map or a struct");
}

std::vector<std::string> read_texts(const mxArray* given) {
  if (!mxIsCell(given)) return {read_text(given)};
  std::vector<std::string> texts;
  const auto cells = read_cells(given);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    texts.push_back(in_cell(i, [&] { return read_text(cells[i]); }));
  }
  return texts;
}

std::vector<Command> session_commands() {
  return {{"connect", connect},
          {"disconnect", disconnect},
          {"close", close},
          {"attributes", attributes},
          {"authenticate", authenticate},
          {"logout", logout},
          {"service", service},
          {"session_listen", session_listen},
          {"find_object_type", find_object_type}};
}

}  // namespace rr::matlab
