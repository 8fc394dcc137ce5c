// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/status.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/channel/texts.hpp"

namespace rr::channel {

Status::Status(const MetricsOptions& options) {
  for (const std::string& place : options.from) {
    if (place == "*") {
      is_for_all_ = true;
    } else {
      from_.push_back(network_of(place));
    }
  }
  for (const std::string& host : options.hosts) hosts_.push_back(in_lower_case(host));
}

Status::Network Status::network_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto address = platform::parse_ip(text.substr(0, slash));
  const unsigned most = address && !address->is_v6 ? 32 : 128;
  unsigned bits = most;
  bool is_right = address.has_value();
  if (is_right && slash != std::string::npos) {
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data() + slash + 1, end, bits);
    is_right = error == std::errc() && at == end && bits <= most;
  }
  if (!is_right) {
    throw Error(ErrorCode::invalid_argument,
                "`" + text + "` is no place to ask for metrics from: an address, " +
                    "`address/bits`, or `*`");
  }
  return {*address, bits};
}

bool Status::contains(const Network& network, const platform::IpAddress& address) {
  if (network.address.is_v6 != address.is_v6) return false;
  const unsigned whole = network.bits / 8;
  const unsigned rest = network.bits % 8;
  if (!std::equal(address.bytes.begin(), address.bytes.begin() + whole,
                  network.address.bytes.begin())) {
    return false;
  }
  if (rest == 0) return true;
  const auto mask = static_cast<std::uint8_t>(0xFFU << (8 - rest));
  return ((address.bytes.at(whole) ^ network.address.bytes.at(whole)) & mask) == 0;
}

void Status::add(Source source) {
  const MutexLock lock(mutex_);
  sources_.push_back(std::move(source));
}

std::string Status::metrics() const {
  std::vector<Source> sources;
  {
    const MutexLock lock(mutex_);
    sources = sources_;
  }
  MetricsText text;
  for (const Source& source : sources) source(text);
  return std::move(text).finish();
}

void Status::set_fault(std::string why) {
  const MutexLock lock(mutex_);
  fault_ = std::move(why);
}

std::string Status::fault() const {
  const MutexLock lock(mutex_);
  return fault_;
}

bool Status::may_ask(std::string_view remote_address) const {
  const auto ip =
      platform::parse_ip(std::string(remote_address.substr(0, remote_address.find('%'))));
  if (!ip) return false;
  if (is_for_all_ || ip->is_loopback()) return true;
  return std::any_of(from_.begin(), from_.end(),
                     [&](const Network& network) { return contains(network, *ip); });
}

}  // namespace rr::channel
