// SPDX-License-Identifier: Apache-2.0
// Local sockets (04, section 7).
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/connected.hpp"
#include "runtime/cpp/src/channel/listening_socket.hpp"
#include "runtime/cpp/src/channel/node_files.hpp"
#include "runtime/cpp/src/channel/tcp_connect.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/channel/trusted_folder.hpp"

namespace rr::channel {
namespace {

constexpr int backlog = 1024;
constexpr int attempts = 4;

Address address_of(const std::string& path) {
  Address address;
  auto& local = reinterpret_cast<sockaddr_un&>(address.storage);
  if (path.size() >= sizeof local.sun_path) {
    throw Error(ErrorCode::invalid_argument,
                "the path of the socket `" + path + "` is longer than " +
                    std::to_string(sizeof local.sun_path - 1) + " bytes");
  }
  local.sun_family = AF_UNIX;
  std::memcpy(local.sun_path, path.c_str(), path.size() + 1);
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size() + 1);
  return address;
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw Error(ErrorCode::connection_error,
              "cannot listen at `" + path + "`: " + std::strerror(error));
}

// A socket that a node of this user has left behind: nobody answers there. Anything else is not
// ours to remove.
bool is_dead(const std::string& path, const Address& address) {
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0 || !S_ISSOCK(found.st_mode) || found.st_uid != geteuid()) {
    return false;
  }
  const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  return connect(socket.get(), reinterpret_cast<const sockaddr*>(&address.storage), address.size) !=
             0 &&
         errno == ECONNREFUSED;
}

// A socket that listens, and its place in the file system, which goes with it.
class PlacedSocket {
 public:
  // Throws rr::Error when there is something already, unless it may be replaced and is dead.
  PlacedSocket(std::string path, mode_t mode, bool may_replace) : path_(std::move(path)) {
    const Address address = address_of(path_);
    socket_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!socket_) fail(path_, errno);
    const auto* const at = reinterpret_cast<const sockaddr*>(&address.storage);
    int result = bind(socket_.get(), at, address.size);
    if (result != 0 && errno == EADDRINUSE && may_replace && is_dead(path_, address)) {
      unlink(path_.c_str());
      result = bind(socket_.get(), at, address.size);
    }
    if (result != 0) fail(path_, errno);
    struct stat made {};
    lstat(path_.c_str(), &made);
    device_ = made.st_dev;
    number_ = made.st_ino;
    // Before it listens, so that nobody comes in whom the mask would have let.
    if (chmod(path_.c_str(), mode) != 0 || ::listen(socket_.get(), backlog) != 0) {
      const int error = errno;
      remove();
      fail(path_, error);
    }
  }
  PlacedSocket(PlacedSocket&&) = default;

  [[nodiscard]] const std::string& path() const { return path_; }
  Descriptor take() { return std::move(socket_); }
  // Another node may have put its own there since.
  void remove() const {
    struct stat found {};
    if (lstat(path_.c_str(), &found) == 0 && found.st_dev == device_ && found.st_ino == number_) {
      unlink(path_.c_str());
    }
  }

 private:
  std::string path_;
  Descriptor socket_;
  dev_t device_ = 0;
  ino_t number_ = 0;
};

LinkTerms local_terms(const NodeOptions& options) {
  LinkTerms terms;
  terms.scheme = "rr+local";
  terms.local_url = "rr+local://";
  terms.traits.is_local = true;
  terms.heartbeat_period = saturated(options.local.heartbeat_period);
  terms.receive_timeout = saturated(options.local.receive_timeout);
  terms.size_before_connect = options.limits.message_size;  // no rule for it (04, section 7.5)
  return terms;
}

PlacedSocket open_at(const std::string& path, mode_t mode) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  if (!open_trusted_folder(folder, {})) fail(path, ENOENT);
  return {path, mode, true};
}

PlacedSocket open_any(const NodeFolder& folder, mode_t mode) {
  for (int attempt = 1;; ++attempt) {
    try {
      return {folder.sockets + "/" + random_letters() + ".sock", mode, false};
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
    // The user's group too, as far as the folder lets it in: who may connect is asked again.
    constexpr mode_t mode = 0770;
    if (url.path.size() > 1) {
      socket_.emplace(open_at(url.path, mode));
      url_ = "rr+local://" + url.path;
    } else {
      const NodeFolder folder =
          is_public ? public_folder(options.local, own_user_name()) : private_folder(options.local);
      make_folder(folder);
      clean_up(folder);
      socket_.emplace(open_any(folder, mode));
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
    if (!is_public) terms.only_user = geteuid();
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
    const std::lock_guard lock(mutex_);
    if (files_) files_->set_nonce(nonce);
  }

 private:
  std::optional<PlacedSocket> socket_;
  std::string url_;
  std::mutex mutex_;
  std::unique_ptr<NodeFiles> files_;
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
