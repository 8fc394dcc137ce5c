// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "gateway/broker_options.hpp"

struct ssl_ctx_st;

namespace rr::gateway {

/// TLS of one connection to a broker: authorities, the certificate of this side, and what
/// was wrong with the broker's. The broker's certificate must be of an authority and for its host.
class BrokerTls {
 public:
  /// Reads the files. Throws rr::Error (invalid_configuration) that names the file.
  BrokerTls(const BrokerOptions& broker, std::string host);
  ~BrokerTls();
  BrokerTls(const BrokerTls&) = delete;
  BrokerTls& operator=(const BrokerTls&) = delete;

  /// For a client of the broker. This must outlive it.
  [[nodiscard]] ssl_ctx_st* context() const { return context_.get(); }
  /// Why the broker's certificate was refused; empty when it was not.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  struct Freed {
    void operator()(ssl_ctx_st* context) const;
  };
  void read_authority(const BrokerOptions& broker);
  void read_certificate(const BrokerOptions& broker);

  std::string host_;
  std::string authority_;
  std::unique_ptr<ssl_ctx_st, Freed> context_;
  std::string trouble_;
};

/// What a line of a library about TLS means to a person; empty when it says nothing.
std::string tls_reason(const std::string& line);

}  // namespace rr::gateway
