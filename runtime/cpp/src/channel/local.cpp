// SPDX-License-Identifier: Apache-2.0
// Local sockets (04, section 7).
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/connected.hpp"
#include "runtime/cpp/src/channel/listening_socket.hpp"
#include "runtime/cpp/src/channel/node_files.hpp"
#include "runtime/cpp/src/channel/tcp_connect.hpp"
#include "runtime/cpp/src/channel/texts.hpp"

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

// Nobody answers at a socket that was left behind.
bool is_dead(const Address& address) {
  const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  return connect(socket.get(), reinterpret_cast<const sockaddr*>(&address.storage), address.size) !=
             0 &&
         errno == ECONNREFUSED;
}

Descriptor open_listening(const std::string& path, bool may_replace) {
  const Address address = address_of(path);
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) fail(path, errno);
  const auto* const at = reinterpret_cast<const sockaddr*>(&address.storage);
  int result = bind(socket.get(), at, address.size);
  if (result != 0 && errno == EADDRINUSE && may_replace && is_dead(address)) {
    unlink(path.c_str());
    result = bind(socket.get(), at, address.size);
  }
  if (result != 0) fail(path, errno);
  // Before it listens, so that nobody comes in whom the mask would have let.
  if (chmod(path.c_str(), 0770) != 0 || ::listen(socket.get(), backlog) != 0) {
    const int error = errno;
    unlink(path.c_str());
    fail(path, error);
  }
  return socket;
}

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

class LocalListener final : public Listener {
 public:
  LocalListener(const Ground& ground, const Url& url, AcceptHandler accept) {
    const NodeOptions& options = *ground.options;
    const bool is_public = url.query.find("public=true") != std::string::npos;
    Descriptor socket;
    if (url.path.size() > 1) {
      path_ = url.path;
      socket = open_listening(path_, true);
      url_ = "rr+local://" + path_;
    } else {
      const NodeFolder folder =
          is_public ? public_folder(options.local, own_user_name()) : private_folder(options.local);
      make_folder(folder);
      clean_up(folder);
      socket = open_any(folder);
      url_ = is_public ? "rr+local://" + own_user_name() + "@localhost" : "rr+local://";
      try {
        files_ =
            std::make_unique<NodeFiles>(folder, options.id, options.name, path_, random_letters());
      } catch (const Error&) {
        unlink(path_.c_str());
        throw;
      }
    }
    listening_ = std::make_shared<ListeningSocket>(ground, std::move(socket), local_terms(options),
                                                   std::move(accept));
    listening_->start();
  }
  ~LocalListener() override {
    listening_->stop();
    unlink(path_.c_str());
  }

  [[nodiscard]] std::vector<std::string> urls() const override { return {url_}; }
  void services_changed(const std::string& nonce) override {
    const std::lock_guard lock(mutex_);
    if (files_) files_->set_nonce(nonce);
  }

 private:
  Descriptor open_any(const NodeFolder& folder) {
    for (int attempt = 1;; ++attempt) {
      path_ = folder.sockets + "/" + random_letters() + ".sock";
      try {
        return open_listening(path_, false);
      } catch (const Error& error) {
        if (attempt == attempts || error.code() == ErrorCode::invalid_argument) throw;
      }
    }
  }

  std::string path_;
  std::string url_;
  std::mutex mutex_;
  std::unique_ptr<NodeFiles> files_;
  std::shared_ptr<ListeningSocket> listening_;
};

class LocalChannel final : public Channel {
 public:
  explicit LocalChannel(Ground ground) : ground_(std::move(ground)) {}

  [[nodiscard]] ChannelTraits traits(std::string_view /*scheme*/) const override {
    return {.message_limit = ground_.options->limits.message_size, .is_local = true};
  }

  std::shared_ptr<Connection> connect(const Url& url, Time deadline,
                                      const AcceptHandler& make_receiver) override {
    std::vector<Address> addresses;
    for (const std::string& path : find_sockets(ground_.options->local, url)) {
      addresses.push_back(address_of(path));
    }
    if (addresses.empty()) {
      throw Error(ErrorCode::node_not_found,
                  "no node " +
                      (url.node_id.is_any() ? "`" + url.node_name + "`" : url.node_id.text()) +
                      " listens on this machine");
    }
    Agreed agreed = connect_stream(addresses, url, ground_, deadline);
    return connected(ground_, std::move(agreed), local_terms(*ground_.options), make_receiver);
  }

  std::unique_ptr<Listener> listen(const Url& url, AcceptHandler accept) override {
    return std::make_unique<LocalListener>(ground_, url, std::move(accept));
  }

 private:
  const Ground ground_;
};

}  // namespace

std::shared_ptr<Channel> make_local_channel(Ground ground) {
  return std::make_shared<LocalChannel>(std::move(ground));
}

}  // namespace rr::channel
