// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace rr::testing {

/// OpenMetrics text, read back: its samples, and what is wrong with its form.
class OpenMetrics {
 public:
  explicit OpenMetrics(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) take(line);
    if (!has_ended_) faults_.emplace_back("no # EOF at the end");
    if (!text.empty() && text.back() != '\n') faults_.emplace_back("no line feed at the end");
  }

  /// The value of `name{labels}`; not a number when it is not there.
  [[nodiscard]] double value(const std::string& sample) const {
    const auto found = samples_.find(sample);
    return found == samples_.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
  }
  /// Of all samples that begin so.
  [[nodiscard]] double sum(const std::string& begin) const {
    double sum = 0;
    for (const auto& [name, value] : samples_) {
      if (name.starts_with(begin)) sum += value;
    }
    return sum;
  }
  /// Names of samples, without labels.
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& [name, value] : samples_) names.insert(name.substr(0, name.find('{')));
    return names;
  }
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

 private:
  void take(const std::string& line) {
    static const std::regex comment("# (TYPE|UNIT|HELP) ([a-z_]+) (.+)");
    static const std::regex sample(
        R"(([a-z_]+)(\{([a-z_]+="([^"\\\n]|\\["\\n])*",?)+\})? ([0-9.e+-]+))");
    std::smatch match;
    if (has_ended_) faults_.push_back("behind the end: " + line);
    if (line == "# EOF") {
      has_ended_ = true;
    } else if (std::regex_match(line, match, comment)) {
      take_comment(match[1], match[2], match[3]);
    } else if (std::regex_match(line, match, sample)) {
      const std::string name = match[1];
      if (!is_of_family(name)) faults_.push_back("not of the family " + family_ + ": " + line);
      const std::string key = line.substr(0, line.rfind(' '));
      if (!samples_.emplace(key, std::strtod(match[5].str().c_str(), nullptr)).second) {
        faults_.push_back("twice: " + key);
      }
    } else {
      faults_.push_back("no line of this format: " + line);
    }
  }
  void take_comment(const std::string& kind, const std::string& family, const std::string& text) {
    if (kind == "TYPE") {
      if (!families_.insert(family).second) faults_.push_back("a family twice: " + family);
      family_ = family;
      type_ = text;
    } else if (family != family_) {
      faults_.push_back(kind + " of another family: " + family);
    }
    if (kind == "UNIT" && !family.ends_with("_" + text)) faults_.push_back("unit of " + family);
  }
  [[nodiscard]] bool is_of_family(const std::string& name) const {
    static const std::map<std::string, std::set<std::string>> suffixes = {
        {"counter", {"_total"}},
        {"gauge", {""}},
        {"info", {"_info"}},
        {"histogram", {"_bucket", "_count", "_sum"}}};
    const auto known = suffixes.find(type_);
    return known != suffixes.end() && name.starts_with(family_) &&
           known->second.contains(name.substr(family_.size()));
  }

  std::map<std::string, double> samples_;
  std::set<std::string> families_;
  std::vector<std::string> faults_;
  std::string family_;
  std::string type_;
  bool has_ended_ = false;
};

}  // namespace rr::testing
