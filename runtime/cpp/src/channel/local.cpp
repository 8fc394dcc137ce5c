// SPDX-License-Identifier: Apache-2.0
// Local sockets (04, section 7).
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/connected.hpp"
#include "runtime/cpp/src/channel/listening_socket.hpp"
#include "runtime/cpp/src/channel/node_files.hpp"
#include "runtime/cpp/src/channel/tcp_connect.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/platform/local_socket.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"
#include "runtime/cpp/src/platform/trusted_folder.hpp"

namespace rr::channel {
namespace {

constexpr int attempts = 4;

using platform::PlacedSocket;

[[noreturn]] void refuse_path(const std::string& path) {
  throw Error(ErrorCode::invalid_argument, "the path of the socket `" + path + "` is longer than " +
                                               std::to_string(platform::longest_local_path()) +
                                               " bytes");
}

Address address_of(const std::string& path) {
  auto address = platform::local_socket_address(path);
  if (!address) refuse_path(path);
  return std::move(*address);
}

[[noreturn]] void fail(const std::string& path, const std::error_code& error) {
  if (error == std::errc::filename_too_long) refuse_path(path);
  throw Error(ErrorCode::connection_error, "cannot listen at `" + path + "`: " + error.message());
}

LinkTerms local_terms(const NodeOptions& options) {
  LinkTerms terms;
  terms.scheme = "rr+local";
  terms.local_url = "rr+local://";
  terms.traits.is_local = true;
  terms.heartbeat_period = saturated(options.local.heartbeat_period);
  terms.receive_timeout = saturated(options.local.receive_timeout);
  terms.size_before_connect = options.limits.message_size;  // no rule for it (04, section 7.5)
  terms.shares_memory = options.local.shared_memory && platform::has_shared_memory();
  return terms;
}

PlacedSocket place(const std::string& path, bool may_replace) {
  std::error_code error;
  PlacedSocket socket(path, may_replace, error);
  if (error) fail(path, error);
  return socket;
}

PlacedSocket open_at(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  if (!platform::open_trusted_folder(folder, {})) {
    fail(path, std::make_error_code(std::errc::no_such_file_or_directory));
  }
  return place(path, true);
}

PlacedSocket open_any(const NodeFolder& folder) {
  for (int attempt = 1;; ++attempt) {
    try {
      return place(folder.sockets + "/" + random_letters() + ".sock", false);
    } catch (const Error& error) {
      if (attempt == attempts || error.code() == ErrorCode::invalid_argument) throw;
    }
  }
}

class LocalListener final : public Listener {
 public:
  LocalListener(const ChannelContext& context, const Url& url, AcceptHandler accept) {
    const NodeOptions& options = *context.options;
    const bool is_public = url.query.find("public=true") != std::string::npos;
    if (url.path.size() > 1) {
      socket_.emplace(open_at(url.path));
      url_ = "rr+local://" + url.path;
    } else {
      const NodeFolder folder =
          is_public ? public_folder(options.local, own_user_name()) : private_folder(options.local);
      make_folder(folder);
      clean_up(folder);
      socket_.emplace(open_any(folder));
      url_ = is_public ? "rr+local://" + own_user_name() + "@localhost" : "rr+local://";
      try {
        files_ = std::make_unique<NodeFiles>(folder, options.id, options.name, socket_->path(),
                                             random_letters());
      } catch (const Error&) {
        socket_->remove();
        throw;
      }
    }
    LinkTerms terms = local_terms(options);
    if (!is_public) terms.only_user = platform::current_user();
    listening_ = std::make_shared<ListeningSocket>(context, socket_->take(), std::move(terms),
                                                   std::move(accept));
    listening_->start();
  }
  ~LocalListener() override {
    listening_->stop();
    socket_->remove();
  }

  [[nodiscard]] std::vector<std::string> urls() const override { return {url_}; }
  void services_changed(const std::string& nonce) override {
    const MutexLock lock(mutex_);
    if (files_) files_->set_nonce(nonce);
  }

 private:
  std::optional<PlacedSocket> socket_;
  std::string url_;
  Mutex mutex_;
  std::unique_ptr<NodeFiles> files_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<ListeningSocket> listening_;
};

class LocalChannel final : public Channel {
 public:
  explicit LocalChannel(ChannelContext context) : context_(std::move(context)) {}

  [[nodiscard]] ChannelTraits traits(std::string_view /*scheme*/) const override {
    return {.message_limit = context_.options->limits.message_size, .is_local = true};
  }

  std::shared_ptr<Connection> connect(const Url& url, Time deadline,
                                      const AcceptHandler& make_receiver) override {
    std::vector<Address> addresses;
    for (FoundSocket& found : find_sockets(context_.options->local, url)) {
      addresses.push_back(address_of(found.path));
      addresses.back().servers = std::move(found.servers);
    }
    if (addresses.empty()) {
      throw Error(ErrorCode::node_not_found, "no node " +
                                                 (url.path.size() > 1    ? "at `" + url.path + "`"
                                                  : url.node_id.is_any() ? "`" + url.node_name + "`"
                                                                         : url.node_id.text()) +
                                                 " listens on this machine");
    }
    Agreed agreed = connect_stream(addresses, url, context_, deadline);
    return connected(context_, std::move(agreed), local_terms(*context_.options), make_receiver);
  }

  std::unique_ptr<Listener> listen(const Url& url, AcceptHandler accept) override {
    return std::make_unique<LocalListener>(context_, url, std::move(accept));
  }

 private:
  const ChannelContext context_;
};

}  // namespace

std::shared_ptr<Channel> make_local_channel(ChannelContext context) {
  return std::make_shared<LocalChannel>(std::move(context));
}

}  // namespace rr::channel
