// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/message_mutation.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <experimental/fuzzed.hpp>
#include <string>
#include <utility>

#include "rr/definition.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

namespace rr::fuzz {
namespace {

namespace element_flag = codec::element_flag;
namespace message_flag = codec::message_flag;

constexpr std::array element_types = {ElementType::void_,
                                      ElementType::double_,
                                      ElementType::single,
                                      ElementType::int8,
                                      ElementType::uint8,
                                      ElementType::int16,
                                      ElementType::uint16,
                                      ElementType::int32,
                                      ElementType::uint32,
                                      ElementType::int64,
                                      ElementType::uint64,
                                      ElementType::string,
                                      ElementType::cdouble,
                                      ElementType::csingle,
                                      ElementType::bool_,
                                      ElementType::structure,
                                      ElementType::vector,
                                      ElementType::dictionary,
                                      ElementType::list,
                                      ElementType::pod,
                                      ElementType::pod_array,
                                      ElementType::pod_multidimarray,
                                      ElementType::namedarray_array,
                                      ElementType::namedarray_multidimarray,
                                      ElementType::multidimarray};

constexpr std::array<std::string_view, 21> paths = {"conformance",
                                                    "conformance.props",
                                                    "conformance.funcs",
                                                    "conformance.errs",
                                                    "conformance.events",
                                                    "conformance.streams",
                                                    "conformance.child",
                                                    "conformance.child.next_child",
                                                    "conformance.child.next_child.next_child",
                                                    "conformance.by_index[0]",
                                                    "conformance.by_index[9]",
                                                    "conformance.by_index[-1]",
                                                    "conformance.by_number[-3]",
                                                    "conformance.by_name[a%20b]",
                                                    "conformance.by_name[broken]",
                                                    "conformance.any_named[c]",
                                                    "conformance.anything",
                                                    "conformance.anything_by_number[2]",
                                                    "conformance.anything_by_number[3].x",
                                                    "RobotRaconteurServiceIndex",
                                                    ""};

// Of elements, besides parameters, fields and numbers.
constexpr std::array<std::string_view, 20> names = {
    "value",        "return",        "dims",        "array",
    "capabilities", "index",         "servicename", "returnservicedefs",
    "ServiceType",  "clientversion", "username",    "credentials",
    "parameter",    "element",       "errorname",   "errorstring",
    "errorparam",   "count",         "0",           "-1"};

constexpr std::array<std::string_view, 16> texts = {"1.2.8",
                                                    "0.8",
                                                    "true",
                                                    "false",
                                                    "conformance",
                                                    "experimental.fuzzed",
                                                    "experimental.fuzzed.Root",
                                                    "experimental.fuzzed.Stats",
                                                    "experimental.fuzzed.Leaf",
                                                    "experimental.fuzzed.Tree",
                                                    "experimental.fuzzed.Sample",
                                                    "experimental.fuzzed.Reading",
                                                    "experimental.fuzzed.Vector3",
                                                    "experimental.fuzzed.Transform",
                                                    "RobotRaconteurServiceIndex",
                                                    "child.next_child"};

constexpr std::array<std::uint64_t, 10> numbers = {0,
                                                   1,
                                                   2,
                                                   3,
                                                   0x7FFFFFFF,
                                                   0x80000000,
                                                   0xFFFFFFFF,
                                                   0x7FF8000000000000,
                                                   0x3FF0000000000000,
                                                   0xFFFFFFFFFFFFFFFF};

const ObjectType& random_object(Random& random) {
  return *random.pick(::experimental::fuzzed::rr_definition.objects);
}

EntryType random_entry_type(Random& random) {
  constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 6> ranges = {
      {{1, 4}, {101, 22}, {501, 2}, {1101, 14}, {1121, 4}, {1131, 60}}};
  if (random.one_in(2)) {
    constexpr std::array likely = {EntryType::property_get_req, EntryType::property_set_req,
                                   EntryType::function_call_req};
    return random.pick(likely);
  }
  if (random.one_in(20)) return static_cast<EntryType>(random.below(0x10000));
  const auto [first, count] = random.pick(ranges);
  return static_cast<EntryType>(first + random.below(count));
}

std::string_view random_name(Random& random) {
  if (random.one_in(2)) return random.pick(names);
  const ObjectType& object = random_object(random);
  const Member& member = random.pick(object.members);
  return member.parameters.empty() ? member.name : random.pick(member.parameters).name;
}

void add_to(std::vector<ElementTree>& elements, std::size_t place, ElementTree element) {
  constexpr std::size_t most = 64;
  if (elements.size() >= most) return;
  elements.insert(elements.begin() + static_cast<std::ptrdiff_t>(place), std::move(element));
}

}  // namespace

void MessageMutation::mutate(MessageTree& message, const MessageTree& other) {
  switch (random_->below(12)) {
    case 0:
      mutate_header(message);
      break;
    case 1:
      mutate_strings(message);
      break;
    case 2:
      mutate_entries(message.entries, other.entries);
      if (message.entries.size() != 1) message.flags |= message_flag::multiple_entries;
      break;
    case 3:
    case 4:
      if (!message.entries.empty()) mutate_entry(random_->pick(message.entries));
      break;
    default: {
      if (message.entries.empty()) break;
      static const Elements none;
      const Elements& others = other.entries.empty() ? none : random_->pick(other.entries).elements;
      mutate_elements(random_->pick(message.entries).elements, others, 0);
      break;
    }
  }
}

MessageTree MessageMutation::random_request() {
  const MessageVersion version = random_->one_in(3) ? MessageVersion::v2 : MessageVersion::v4;
  const ObjectType& object = random_object(*random_);
  const Member& member = random_->pick(object.members);
  EntryType type = random_entry_type(*random_);
  std::string_view path = random_->pick(paths);
  if (!random_->one_in(4)) {
    type = member.kind == MemberKind::function ? EntryType::function_call_req
           : random_->one_in(2)                ? EntryType::property_get_req
                                               : EntryType::property_set_req;
    constexpr std::array<std::string_view, 7> objects = {
        "Root",       "PropertyBoard", "FunctionBoard", "ErrorBoard",
        "EventBoard", "StreamBoard",   "Child"};
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (object.name.ends_with(objects[i])) path = paths[i];
    }
  }
  MessageTree message = session_request(version, type, path, member.name);
  if (static_cast<std::uint16_t>(type) < 500) message = special_request(version, type, path);
  EntryTree& entry = message.entries.front();
  if (type == EntryType::property_set_req) entry.elements = random_elements("value");
  for (const Parameter& parameter : member.parameters) {
    if (type != EntryType::function_call_req) break;
    entry.elements.push_back(random_elements(parameter.name).front());
    entry.elements.back().type = parameter.type->element_type();
    mutate_payload(entry.elements.back());
  }
  return message;
}

MessageMutation::Elements MessageMutation::random_elements(std::string_view first_name) {
  Elements elements = {named_element(first_name, random_->pick(element_types), {})};
  mutate_payload(elements.front());
  return elements;
}

void MessageMutation::mutate_header(MessageTree& message) {
  switch (random_->below(10)) {
    case 0:
      message.flags ^= static_cast<std::uint8_t>(1U << random_->below(8));
      break;
    case 1:
    case 2:
      change_version(
          message, message.version == MessageVersion::v2 ? MessageVersion::v4 : MessageVersion::v2);
      break;
    case 3:
      message.receiver_endpoint = random_->one_in(4) ? random_->below(3) : service_endpoint_place;
      break;
    case 4:
      message.sender_endpoint = random_->one_in(4) ? random_->below(3) : client_endpoint;
      break;
    case 5:
      message.receiver_node = random_->one_in(2) ? NodeId{} : service_node();
      break;
    case 6:
      message.sender_node = random_->one_in(4) ? service_node() : client_node();
      break;
    case 7:
      message.receiver_name = random_->one_in(2) ? service_node_name : client_node_name;
      message.flags |= message_flag::routing;
      break;
    case 8:
      mutate_text(message.metadata);
      message.flags |= message_flag::meta;
      break;
    default:
      message.message_id = static_cast<std::uint16_t>(random_->below(0x10000));
      message.priority = static_cast<std::uint16_t>(random_->below(3));
      break;
  }
}

// Codes of the message's own table are odd; those of the standard one are even.
void MessageMutation::mutate_strings(MessageTree& message) {
  if (message.version != MessageVersion::v4) {
    change_version(message, MessageVersion::v4);
    return;
  }
  const std::uint32_t code = random_->below(random_->one_in(2) ? 8 : 300);
  if (random_->one_in(2)) {
    message.flags |= message_flag::string_table;
    message.strings.emplace_back(code,
                                 random_->one_in(2) ? random_->pick(texts) : random_->pick(paths));
  } else if (!message.strings.empty() && random_->one_in(4)) {
    message.strings.pop_back();
  }
  if (message.entries.empty()) return;
  EntryTree& entry = random_->pick(message.entries);
  namespace entry_flag = codec::entry_flag;
  switch (random_->below(4)) {
    case 0:
      entry.service_path_code = code;
      entry.flags =
          static_cast<std::uint8_t>((entry.flags & ~entry_flag::path_text) | entry_flag::path_code);
      break;
    case 1:
      entry.member_code = code;
      entry.flags = static_cast<std::uint8_t>((entry.flags & ~entry_flag::member_text) |
                                              entry_flag::member_code);
      break;
    default: {
      if (entry.elements.empty()) break;
      ElementTree& element = random_->pick(entry.elements);
      element.name_code = code;
      element.flags = static_cast<std::uint8_t>((element.flags & ~element_flag::name_text) |
                                                element_flag::name_code);
      break;
    }
  }
}

void MessageMutation::mutate_entries(std::vector<EntryTree>& entries,
                                     const std::vector<EntryTree>& others) {
  constexpr std::size_t most = 32;
  if (entries.empty()) {
    entries = others;
    return;
  }
  const std::size_t place = random_->below(entries.size());
  const auto at = entries.begin() + static_cast<std::ptrdiff_t>(place);
  switch (random_->below(4)) {
    case 0:
      entries.erase(at);
      break;
    case 1: {
      EntryTree copy = *at;
      if (entries.size() < most) entries.insert(at, std::move(copy));
      break;
    }
    case 2:
      std::swap(*at, entries.front());
      break;
    default:
      if (!others.empty() && entries.size() < most) entries.push_back(random_->pick(others));
      break;
  }
}

void MessageMutation::mutate_entry(EntryTree& entry) {
  switch (random_->below(10)) {
    case 0:
    case 1:
      entry.type = random_entry_type(*random_);
      break;
    case 2:
    case 3:
      entry.service_path = random_->pick(paths);
      break;
    case 4:
      mutate_text(entry.service_path);
      break;
    case 5:
    case 6:
      entry.member = random_->pick(random_object(*random_).members).name;
      break;
    case 7:
      mutate_text(entry.member);
      break;
    case 8:
      entry.flags ^= static_cast<std::uint8_t>(1U << random_->below(8));
      break;
    default:
      entry.request_id = random_->below(5);
      entry.error = static_cast<std::uint16_t>(random_->one_in(2) ? 0 : random_->below(160));
      break;
  }
}

// Goes down into nested elements, but for a change now and then on the way.
void MessageMutation::mutate_elements(Elements& elements, const Elements& others, int depth) {
  if (elements.empty()) {
    if (!others.empty() && random_->one_in(2)) {
      elements.push_back(random_->pick(others));
    } else {
      elements = random_elements(random_name(*random_));
    }
    return;
  }
  const std::size_t place = random_->below(elements.size());
  ElementTree& element = elements[place];
  if (!element.elements.empty() && depth < 64 && !random_->one_in(4)) {
    const bool goes_down_too = !others.empty() && random_->one_in(2);
    mutate_elements(element.elements, goes_down_too ? random_->pick(others).elements : others,
                    depth + 1);
    return;
  }
  switch (random_->below(12)) {
    case 0:
      elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(place));
      break;
    case 1: {
      ElementTree copy = element;
      add_to(elements, place, std::move(copy));
      break;
    }
    case 2:
      std::swap(element, elements.front());
      break;
    case 3:
      if (!others.empty()) {  // what is in another one under the name of this
        ElementTree taken = random_->pick(others);
        std::swap(taken.name, element.name);
        std::swap(taken.number, element.number);
        element = std::move(taken);
      }
      break;
    case 4:
      if (!others.empty()) add_to(elements, place, random_->pick(others));
      break;
    default:
      mutate_element(element);
      break;
  }
}

void MessageMutation::mutate_element(ElementTree& element) {
  switch (random_->below(14)) {
    case 0:
      element.type = random_->pick(element_types);
      if (!is_nested(element.type)) element.elements.clear();
      mutate_payload(element);
      break;
    case 1:
      element.name = random_name(*random_);
      element.flags |= element_flag::name_text;
      break;
    case 2:
      element.number = static_cast<std::int32_t>(random_->below(5)) - 1;
      element.flags = static_cast<std::uint8_t>(
          (element.flags & ~(element_flag::name_text | element_flag::name_code)) |
          element_flag::number);
      break;
    case 3:
      element.type_name = random_->pick(texts);
      element.flags |= element_flag::type_name_text;
      break;
    case 4:
      mutate_text(random_->one_in(2) ? element.type_name : element.name);
      break;
    case 5:
      element.flags ^= static_cast<std::uint8_t>(1U << random_->below(8));
      break;
    case 6:
      wrap(element);
      break;
    case 7:
      element.type = ElementType::void_;
      element.payload.clear();
      element.elements.clear();
      element.count = random_->below(2);
      break;
    default:
      mutate_payload(element);
      break;
  }
}

void MessageMutation::mutate_payload(ElementTree& element) {
  if (is_nested(element.type)) {
    element.payload.clear();
    if (element.elements.empty()) element.elements = random_elements(random_->pick(names));
    return;
  }
  if (element.type == ElementType::string && random_->one_in(2)) {
    const std::string_view text = random_->pick(texts);
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    element.payload.assign(begin, begin + text.size());
    return;
  }
  const std::size_t item = item_size(element.type);
  if (random_->one_in(3)) {
    element.payload.resize(std::max<std::size_t>(item, 1) * random_->below(9));
    const std::uint64_t number = random_->pick(numbers);
    for (std::size_t at = 0; at + item <= element.payload.size() && item != 0; at += item) {
      std::memcpy(element.payload.data() + at, &number, std::min(item, sizeof number));
    }
  } else {
    constexpr std::size_t room = 32;
    const std::size_t size = element.payload.size();
    element.payload.resize(size + room);
    element.payload.resize(
        mutate_bytes_(reinterpret_cast<std::uint8_t*>(element.payload.data()), size, size + room));
  }
  if (item == 0) element.payload.clear();
  if (item > 1 && !random_->one_in(16)) {
    element.payload.resize((element.payload.size() + item - 1) / item * item);
  }
}

void MessageMutation::mutate_text(std::string& text) {
  constexpr std::size_t room = 16;
  const std::size_t size = text.size();
  text.resize(size + room);
  text.resize(mutate_bytes_(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
}

// Puts an element into a container, or into many.
void MessageMutation::wrap(ElementTree& element) {
  constexpr std::array containers = {ElementType::list, ElementType::vector,
                                     ElementType::dictionary, ElementType::structure};
  for (std::uint32_t left = random_->one_in(8) ? random_->below(66) : 1; left != 0; --left) {
    ElementTree outer = named_element(element.name, random_->pick(containers), {});
    element.name = "0";
    element.number = 0;
    outer.elements.push_back(std::move(element));
    element = std::move(outer);
  }
}

}  // namespace rr::fuzz
