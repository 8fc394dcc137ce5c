// SPDX-License-Identifier: Apache-2.0
#include "cli/live/node_metrics.hpp"

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <charconv>
#include <chrono>
#include <limits>
#include <rr/url.hpp>

namespace robdef::live {
namespace {

// A node's answer has a few ten thousand bytes.
constexpr std::size_t longest_answer = 1024 * 1024;

// The value of a label in `name{a="1",b="2"}`; empty when it has none.
std::string_view label_of(std::string_view sample, std::string_view label) {
  const std::string begin = std::string(label) + "=\"";
  const std::size_t at = sample.find(begin);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = sample.substr(at + begin.size());
  return rest.substr(0, rest.find('"'));
}

std::optional<double> number_in(std::string_view text) {
  if (text == "+Inf") return std::numeric_limits<double>::infinity();
  double number = 0;
  const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || at != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string answer_of(const rr::Url& url) {
  const std::string host =
      url.host.find(':') == std::string::npos ? url.host : "[" + url.host + "]";
  boost::asio::ip::tcp::iostream peer;
  peer.expires_after(std::chrono::seconds(2));
  peer.connect(url.host, std::to_string(url.port));
  peer << "GET /metrics HTTP/1.1\r\nHost: " << host << ':' << url.port << "\r\n\r\n" << std::flush;
  constexpr std::string_view end = "# EOF\n";
  std::string text;
  for (std::string line; text.size() < longest_answer && std::getline(peer, line);) {
    text += line + "\n";
    if (text.ends_with(end)) break;
    if (text.size() == line.size() + 1 && !line.starts_with("HTTP/1.1 200 ")) break;
  }
  return text.ends_with(end) ? text : std::string();
}

}  // namespace

NodeMetrics::NodeMetrics(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const std::size_t blank = line.rfind(' ');
    if (line.starts_with('#') || blank == std::string_view::npos) continue;
    if (const auto value = number_in(line.substr(blank + 1))) {
      samples_.emplace(line.substr(0, blank), *value);
    }
  }
}

double NodeMetrics::value(const std::string& sample) const {
  const auto found = samples_.find(sample);
  return found == samples_.end() ? 0 : found->second;
}

double NodeMetrics::sum(std::string_view name) const {
  double sum = 0;
  for (const auto& [sample, value] : samples_) {
    if (std::string_view(sample).substr(0, sample.find('{')) == name) sum += value;
  }
  return sum;
}

std::map<double, double> NodeMetrics::latencies() const {
  std::map<double, double> below;
  for (const auto& [sample, value] : samples_) {
    if (!sample.starts_with("rpc_server_call_duration_seconds_bucket{")) continue;
    if (const auto bound = number_in(label_of(sample, "le"))) below[*bound] += value;
  }
  return below;
}

std::optional<double> latency(const NodeMetrics& before, const NodeMetrics& now, double share) {
  std::map<double, double> below = now.latencies();
  for (const auto& [bound, count] : before.latencies()) below[bound] -= count;
  if (below.empty() || !(below.rbegin()->second > 0)) return std::nullopt;
  const double wanted = share * below.rbegin()->second;
  for (const auto& [bound, count] : below) {
    if (count >= wanted) return bound;
  }
  return below.rbegin()->first;
}

std::optional<NodeMetrics> ask_for_metrics(const std::string& url) {
  const rr::Url parsed = rr::Url::parse(url);
  if (parsed.scheme != "rr+tcp" && parsed.scheme != "tcp" && parsed.scheme != "rr+ws") {
    return std::nullopt;
  }
  const std::string text = answer_of(parsed);
  if (text.empty()) return std::nullopt;
  return NodeMetrics(text);
}

}  // namespace robdef::live
