// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The two lists beside the suite: where ours departs from a recording on purpose, and what it
/// cannot do yet. A line has fields separated by `|`; `#` begins a comment. The scenario may be
/// followed by the channels that are meant, all without them: `connect over tls rrs+ws`.
namespace rr::conformance {

enum class Role { decode, encode, service, client };
std::string_view name_of(Role role);

/// A played scenario, or the values or malformed inputs of one version.
struct Run {
  std::string scenario;
  std::string version;  ///< v2, v4, v4st
  Role role = Role::decode;
  std::string channel = "tcp";
};

/// One line of either list. `*` in a field stands for everything.
class ListEntry {
 public:
  ListEntry(std::vector<std::string> fields, std::string where_listed);

  [[nodiscard]] bool covers(const Run& run) const;
  /// Whether runs over this channel are meant.
  [[nodiscard]] bool is_of_channel(std::string_view channel) const;
  /// `step 31`, `case NAME`, `*`, or a kind of frame.
  [[nodiscard]] const std::string& place() const { return place_; }
  /// deviations: what ours does instead; empty in expected failures.
  [[nodiscard]] const std::string& instead() const { return instead_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] const std::string& where_listed() const { return where_listed_; }

  /// Set when a run met what the entry speaks of; an entry that nothing ever meets is stale.
  mutable bool met = false;

 private:
  std::string scenario_;
  std::string channels_;
  std::string versions_;
  std::string role_;
  std::string place_;
  std::string instead_;
  std::string reason_;
  std::string where_listed_;
};

/// `scenario | versions | role | place | what ours does instead | why`
class Deviations {
 public:
  Deviations() = default;
  /// `borrowed` when the list was written for other captures: not each entry must occur in these.
  explicit Deviations(const std::filesystem::path& file, bool borrowed = false);
  /// Null when nothing is listed there.
  [[nodiscard]] const ListEntry* find(const Run& run, std::string_view place) const;
  [[nodiscard]] const std::vector<ListEntry>& entries() const { return entries_; }
  [[nodiscard]] bool are_borrowed() const { return are_borrowed_; }

 private:
  std::vector<ListEntry> entries_;
  bool are_borrowed_ = false;
};

/// `language | scenario | versions | role | place | why`
class ExpectedFailures {
 public:
  ExpectedFailures() = default;
  ExpectedFailures(const std::filesystem::path& file, std::string_view language);
  [[nodiscard]] const ListEntry* find(const Run& run, std::string_view place) const;
  [[nodiscard]] const std::vector<ListEntry>& entries() const { return entries_; }

 private:
  std::vector<ListEntry> entries_;
};

/// The places that the lists use: one step, frame or malformed input, or a kind of frame wherever
/// it is.
std::string step_place(int step);
std::string frame_place(int frame);
std::string case_place(std::string_view name);
/// A step of a hand-made scenario by its label.
std::string request_place(std::string_view label);
/// An answer with code 100 and a name that the recorded library's language gave to an exception.
std::string host_error_place(std::string_view error_name);
inline constexpr std::string_view whole_run = "*";
inline constexpr std::string_view repeated_type_answer = "repeated ObjectTypeNameRet";
inline constexpr std::string_view even_type = "entry of an even type";
inline constexpr std::string_view no_entries = "message without entries";
inline constexpr std::string_view high_index_byte = "index byte above 0x7f";

}  // namespace rr::conformance
