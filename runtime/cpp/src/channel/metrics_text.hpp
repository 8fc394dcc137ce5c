// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace rr::channel {

/// Writes OpenMetrics 1.0 text: families of samples.
class MetricsText {
 public:
  struct Family {
    std::string_view name;  ///< without `_total`; ends in the unit, if there is one
    std::string_view type;  ///< `counter`, `gauge`, `histogram`, `info`
    std::string_view help;
    std::string_view unit{};
  };
  using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

  /// Begins a family; its samples follow.
  void begin(const Family& family);
  /// A sample of the family. `suffix`: `_total` of counters, `_bucket` and so on.
  void sample(std::string_view suffix, Labels labels, std::uint64_t value);
  void sample(std::string_view suffix, Labels labels, double value);
  /// A family of one sample without labels.
  void counter(const Family& family, std::uint64_t value);
  void gauge(const Family& family, std::uint64_t value);
  /// All of it, with its end.
  [[nodiscard]] std::string finish() &&;

  /// A number of seconds as OpenMetrics writes it: `0.0025`, `1.0`.
  static std::string seconds_text(std::uint64_t nanoseconds);

 private:
  void begin_sample(std::string_view suffix, Labels labels);

  std::string text_;
  std::string family_;
};

}  // namespace rr::channel
