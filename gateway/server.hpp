// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "gateway/exporter.hpp"
#include "gateway/topics.hpp"

namespace rr::gateway {

/// A far robot's service, and its name here.
struct ServedService {
  ServiceAddress address;
  std::string name;  ///< of the service at this node
  /// Users of this gateway (PasswordUsers), one of whom each client has to be; empty: no logins.
  std::string users_file{};
  /// What each of them may do here (ServiceOptions::rights_file); empty: everything.
  std::string rights_file{};
};

/// How far robots are offered.
struct ServerOptions {
  std::vector<ServedService> services;
  std::string reader;                       ///< as export files declare it
  std::string user;                         ///< of the broker; empty: as `reader`
  std::chrono::milliseconds limit{10'000};  ///< of each request to a robot
  std::chrono::milliseconds repeat{1'000};  ///< of a request without an answer
  /// From one message that clients' sessions at robots are in use to the next.
  std::chrono::milliseconds session_alive{5'000};
};

/// The gateway beside clients: offers services of far robots, found on a broker, as ordinary
/// services of a node. They appear as soon as the broker has their definitions.
class Server {
 public:
  /// Starts both carriers. Node and carriers must outlive it; handlers of the node wait for robots,
  /// so it needs threads. Throws rr::Error: invalid_argument for names, invalid_configuration for
  /// files of users and rights.
  Server(ServerOptions options, Node& node, const Carriers& carriers, Log log);
  /// Closes the services.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace rr::gateway
