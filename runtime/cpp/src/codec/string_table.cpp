// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "rr/reader.hpp"

namespace rr {
namespace {

// 02, section 6.3. The codes go in steps of four, with one gap: first_part texts from 0 on, the
// others from second_start on.
constexpr std::uint32_t code_step = 4;
constexpr std::size_t first_part = 78;
constexpr std::uint32_t second_start = 512;

constexpr std::array<std::string_view, 113> texts = {
    "",
    "array",
    "attributes",
    "AuthenticateUser",
    "capabilities",
    "capabilities2",
    "clientversion",
    "confirmcodes",
    "Continue",
    "count",
    "CreateConnection",
    "credentials",
    "data",
    "DimCount",
    "Dimensions",
    "dims",
    "errorname",
    "errorparam",
    "errorstring",
    "errorsubname",
    "extraimports",
    "false",
    "GetRemoteNodeID",
    "index",
    "Length",
    "LogoutUser",
    "MaxTransferSize",
    "memorypos",
    "messageversion",
    "MonitorContinueEnter",
    "MonitorEnter",
    "MonitorExit",
    "mutualauth",
    "nanoseconds",
    "nodeid",
    "nodeid",
    "nodename",
    "nolock",
    "nolockread",
    "null",
    "objectimplements",
    "objecttype",
    "OK",
    "packet",
    "packetnumber",
    "packettime",
    "parameter",
    "password",
    "pause",
    "perclient",
    "readonly",
    "ReleaseClientObjectLock",
    "ReleaseObjectLock",
    "requestack",
    "RequestClientObjectLock",
    "RequestObjectLock",
    "resume",
    "return",
    "returnservicedefs",
    "robotraconteur",
    "RobotRaconteur",
    "RobotRaconteur.TimeSpec",
    "seconds",
    "seqno",
    "service",
    "servicedef",
    "servicedefs",
    "ServiceIndex",
    "servicename",
    "servicepath",
    "ServiceType",
    "stringtable",
    "timeout",
    "timespec",
    "timestamp",
    "true",
    "unreliable",
    "urgent",
    "username",
    "value",
    "writeonly",
    "Attributes",
    "ConnectionURL",
    "GetDetectedNodes",
    "GetLocalNodeServices",
    "GetRoutedNodes",
    "LocalNodeServicesChanged",
    "Name",
    "NodeID",
    "NodeInfo",
    "NodeName",
    "RobotRaconteurServiceIndex",
    "RobotRaconteurServiceIndex.NodeInfo",
    "RobotRaconteurServiceIndex.ServiceIndex",
    "RobotRaconteurServiceIndex.ServiceInfo",
    "RootObjectImplements",
    "RootObjectType",
    "ServiceIndex",
    "ServiceIndexConnectionURL",
    "ServiceInfo",
    "node",
    "level",
    "component",
    "componentname",
    "componentobjectid",
    "endpoint",
    "member",
    "message",
    "time",
    "sourcefile",
    "sourceline",
    "threadid",
    "fiberid",
};

constexpr std::uint32_t code_at(std::size_t index) {
  const auto number = static_cast<std::uint32_t>(index);
  if (index < first_part) return number * code_step;
  return second_start + (number - static_cast<std::uint32_t>(first_part)) * code_step;
}
static_assert(texts[first_part] == "username" && code_at(texts.size() - 1) == 648);

// Indices of the texts in ascending order, the lower code of two equal ones first.
constexpr auto by_text = [] {
  std::array<std::uint8_t, texts.size()> order{};
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint8_t>(i);
  std::sort(order.begin(), order.end(), [](std::uint8_t a, std::uint8_t b) {
    return texts[a] != texts[b] ? texts[a] < texts[b] : a < b;
  });
  return order;
}();

}  // namespace

std::optional<std::string_view> standard_string(std::uint32_t code) {
  if (code % code_step != 0) return std::nullopt;
  const std::size_t step = code / code_step;
  if (step < first_part) return texts[step];
  if (code < second_start) return std::nullopt;
  const std::size_t index = first_part + (code - second_start) / code_step;
  if (index >= texts.size()) return std::nullopt;
  return texts[index];
}

std::optional<std::uint32_t> standard_code(std::string_view text) {
  const auto* found = std::lower_bound(
      by_text.begin(), by_text.end(), text,
      [](std::uint8_t index, std::string_view wanted) { return texts[index] < wanted; });
  if (found == by_text.end() || texts[*found] != text) return std::nullopt;
  return code_at(*found);
}

StringTable& StringTable::operator=(const StringTable& other) {
  size_ = other.size_;
  standard_ = other.standard_;
  if (this != &other) std::copy_n(other.entries_, size_, entries_);
  return *this;
}

bool StringTable::add(std::uint32_t code, std::string_view text) {
  if (size_ == capacity || code % 2 == 0) return false;
  Entry* const end = entries_ + size_;
  Entry* place = std::lower_bound(
      entries_, end, code,
      [](const Entry& entry, std::uint32_t wanted) { return entry.code < wanted; });
  if (place != end && place->code == code) return true;
  std::copy_backward(place, end, end + 1);
  *place = {code, static_cast<std::uint32_t>(text.size()), text.data()};
  ++size_;
  return true;
}

std::optional<std::string_view> StringTable::find(std::uint32_t code) const {
  if (code % 2 == 0) return standard_ ? standard_string(code) : std::nullopt;
  const Entry* const end = entries_ + size_;
  // Writers count 1, 3, 5, ... so the code mostly says where its entry is.
  const Entry* found = entries_ + code / 2;
  if (code / 2 >= size_ || found->code != code) {
    found = std::lower_bound(entries_, end, code, [](const Entry& entry, std::uint32_t wanted) {
      return entry.code < wanted;
    });
  }
  if (found == end || found->code != code) return std::nullopt;
  return std::string_view(found->text, found->size);
}

}  // namespace rr
