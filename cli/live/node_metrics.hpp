// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What a node counts (docs/howto/monitoring.md), and what follows from two looks at it.
namespace robdef::live {

/// The samples of one answer to `GET /metrics`.
class NodeMetrics {
 public:
  /// Takes lines that are samples, and leaves out all others.
  explicit NodeMetrics(std::string_view text);

  /// Of a sample `name{labels}` as the node writes it; 0 when there is none.
  [[nodiscard]] double value(const std::string& sample) const;
  /// Of all samples of a name.
  [[nodiscard]] double sum(std::string_view name) const;
  /// Requests below each bound of the histogram of all kinds together, in seconds, the last one
  /// without a bound.
  [[nodiscard]] std::map<double, double> latencies() const;

 private:
  std::map<std::string, double> samples_;
};

/// The time in seconds within which `share` of the requests between two looks were answered: the
/// bound of its bucket. Nothing when there were none.
std::optional<double> latency(const NodeMetrics& before, const NodeMetrics& now, double share);

/// Asks the node of a service's URL; nothing where it tells nothing, cannot be reached within two
/// seconds, or uses TLS.
std::optional<NodeMetrics> ask_for_metrics(const std::string& url);

}  // namespace robdef::live
