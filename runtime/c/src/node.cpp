// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/node.hpp"

#include <utility>

#include "rr/codec.hpp"
#include "rr/type.hpp"
#include "runtime/c/src/security.hpp"

namespace rr::capi {
namespace {

void set(std::chrono::milliseconds& option, std::int32_t milliseconds) {
  if (milliseconds != 0) option = duration(milliseconds);
}

template <class T, class U>
void set(T& option, U value) {
  if (value != 0) option = static_cast<T>(value);
}

Offer offer(std::uint32_t without, bool string_table) {
  return {.message_v4 = (without & RR_WITHOUT_V4) == 0,
          .string_table = string_table && (without & RR_WITHOUT_STRING_TABLE) == 0,
          .combined_connect = (without & RR_WITHOUT_COMBINED_CONNECT) == 0};
}

NodeOptions read_options(const rr_node_options& given) {
  NodeOptions options;
  options.audit = read_audit(given.audit);  // first: whatever else is wrong, it is dropped
  options.name = text(given.name);
  options.id = id_of(given.id);
  options.client_offer = offer(given.client_without, true);
  options.server_offer = offer(given.server_without, given.server_string_table != 0);
  set(options.max_threads, given.max_threads);
  set(options.request_timeout, given.request_timeout_ms);
  set(options.connect_timeout, given.connect_timeout_ms);
  set(options.first_message_timeout, given.first_message_timeout_ms);
  set(options.heartbeat_period, given.heartbeat_period_ms);
  set(options.receive_timeout, given.receive_timeout_ms);
  set(options.keep_alive_period, given.keep_alive_period_ms);
  set(options.client_timeout, given.client_timeout_ms);
  set(options.generator_timeout, given.generator_timeout_ms);
  set(options.limits.message_size, given.message_size);
  set(options.memory_transfer_limit, given.memory_transfer_limit);
  set(options.send_queue_limit, given.send_queue_limit);
  set(options.request_queue_limit, given.request_queue_limit);
  set(options.max_connections, given.max_connections);
  options.tls = read_tls(given.tls);
  options.local.shared_memory = given.shared_memory != 0;
  set(options.spin, given.spin_us);
  return options;
}

// The node's options keep what must stay as long as anything of the node does.
void set_log(NodeOptions& options, const rr_node_options& given, std::shared_ptr<Context> context,
             std::shared_ptr<Keeper> keeper) {
  options.log = [log = given.log, context = std::move(context), keeper = std::move(keeper)](
                    LogLevel level, std::string_view text) {
    if (log != nullptr) log(context->data(), static_cast<std::uint32_t>(level), view(text));
  };
}

// How to connect, as the runtime takes it. The options' functions keep their context.
class Connecting {
 public:
  Connecting(const rr_str* urls, std::size_t url_count, const rr_connect_options* given)
      : options_(known(given)),
        context_(std::make_shared<Context>(options_.context, options_.drop)),
        username_(text(options_.username)),
        object_type_(text(options_.object_type)) {
    if (url_count == 0) refuse_argument("there is no URL");
    for (std::size_t i = 0; i < url_count; ++i) {
      urls_.emplace_back(text((&need(urls, "there are no URLs"))[i]));
    }
    if (options_.credentials.count != 0) {
      credentials_ = read_map(options_.credentials);
    } else if (!username_.empty()) {
      credentials_.emplace("password", std::string(text(options_.password)));
    }
  }

  // Each URL in its turn. Throws what the last one does.
  [[nodiscard]] rr_client* connect(Node& node) const {
    for (std::size_t i = 0;; ++i) {
      try {
        return connect(node, urls_[i]);
      } catch (const Error&) {
        if (i + 1 == urls_.size()) throw;
      }
    }
  }

 private:
  rr_client* connect(Node& node, const std::string& url) const {
    auto tables = std::make_shared<ClientTables>();
    ConnectOptions options;
    options.username = username_;
    options.credentials = credentials_;
    options.object_type = object_type_;
    options.request_timeout = duration(options_.request_timeout_ms);
    options.allow_clear_credentials = options_.allow_clear_credentials != 0;
    options.definition_reader = tables;
    // Both always, since it is they that keep the context.
    options.on_closed = [call = options_.on_closed, context = context_](const Error& why) {
      if (call != nullptr) call(context->data(), &ErrorInfo(why).info());
    };
    options.on_path_released = [call = options_.on_path_released,
                                context = context_](const std::string& path) {
      if (call != nullptr) call(context->data(), view(path));
    };
    auto client = node.connect<Stub>(url, std::move(options));
    auto root = std::dynamic_pointer_cast<RawStub>(client.stub());
    return new rr_client{std::move(static_cast<ClientBase&>(client)), std::move(tables),
                         std::move(root)};
  }

  const rr_connect_options options_;
  const std::shared_ptr<Context> context_;
  const std::string username_;
  const std::string object_type_;
  std::vector<std::string> urls_;
  std::map<std::string, VarValue> credentials_;
};

}  // namespace

rr_completion check(const rr_completion* completion) {
  const rr_completion& given = need(completion, "there is no completion");
  need(given.done, "the completion has no function");
  return given;
}

std::map<std::string, VarValue> read_map(const rr_elements& elements) {
  VarStringMap map;
  if (elements.count == 0) return map;
  const Values values(&elements);
  static_cast<void>(values.single());
  decode_value(values.bytes(), type_of<VarStringMap>, &map, values.version(), nullptr, {});
  return map;
}

}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::need;

extern "C" {

rr_status rr_node_new(const rr_node_options* options, rr_node** out_node, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_node) = nullptr;
    const rr_node_options given = rr::capi::known(options);
    auto context = std::make_shared<rr::capi::Context>(given.context, given.drop);
    auto keeper = std::make_shared<rr::capi::Keeper>();
    rr::NodeOptions read = rr::capi::read_options(given);
    rr::capi::set_log(read, given, std::move(context), keeper);
    *out_node = new rr_node{std::move(keeper), std::make_shared<rr::Node>(std::move(read))};
  });
}

// Connecting that goes on may hold the node until then.
void rr_node_release(rr_node* node) {
  rr_node_shutdown(node);
  rr::capi::release(node);
}

void rr_node_shutdown(rr_node* node) {
  guarded_or(0, [&] {
    if (node != nullptr) node->node->shutdown();
    return 0;
  });
}

rr_node_id rr_node_get_id(const rr_node* node) {
  return node != nullptr ? rr::capi::id_of(node->node->id()) : rr_node_id{};
}

rr_str rr_node_get_name(const rr_node* node) {
  return node != nullptr ? rr::capi::view(node->node->name()) : rr_str{};
}

rr_status rr_node_listen(rr_node* node, rr_str url, uint16_t* out_port, rr_error** error) {
  return guarded(error, [&] {
    const uint16_t port = need(node, "there is no node").node->listen(rr::capi::text(url));
    if (out_port != nullptr) *out_port = port;
  });
}

rr_status rr_node_urls(const rr_node* node, rr_str service, rr_data** out_data, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_data) = nullptr;
    std::string lines;
    for (const std::string& url :
         need(node, "there is no node").node->urls(rr::capi::text(service))) {
      lines += url + "\n";
    }
    *out_data = rr::capi::Data::text(lines).hand_out();
  });
}

rr_status rr_node_adopt(rr_node* node, int descriptor, rr_error** error) {
  return guarded(error, [&] { need(node, "there is no node").node->adopt(descriptor); });
}

rr_status rr_client_connect(rr_node* node, const rr_str* urls, size_t url_count,
                            const rr_connect_options* options, rr_client** out_client,
                            rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_client) = nullptr;
    const rr::capi::Connecting connecting(urls, url_count, options);
    *out_client = connecting.connect(*need(node, "there is no node").node);
  });
}

rr_status rr_client_connect_async(rr_node* node, const rr_str* urls, size_t url_count,
                                  const rr_connect_options* options,
                                  const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const auto connecting = std::make_shared<const rr::capi::Connecting>(urls, url_count, options);
    const rr_completion done = rr::capi::check(completion);
    const std::shared_ptr<rr::Node> of = need(node, "there is no node").node;
    of->run_aside([of, connecting, done] {
      rr_client* client = nullptr;
      rr_error* failure = nullptr;
      guarded(&failure, [&] { client = connecting->connect(*of); });
      done.done(done.context, failure, client);
    });
  });
}

}  // extern "C"
