// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/answer_mutation.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

namespace rr::fuzz {
namespace {

// Large enough to matter, small enough to be changed a hundred times a second.
constexpr std::size_t most_bytes = 16 * 1024;
constexpr std::size_t most_elements = 300;

constexpr std::array to_clients = {EntryType::stream_op_ret,
                                   EntryType::stream_check_capability_ret,
                                   EntryType::get_service_desc_ret,
                                   EntryType::object_type_name_ret,
                                   EntryType::service_closed,
                                   EntryType::connect_client_ret,
                                   EntryType::disconnect_client_ret,
                                   EntryType::connection_test,
                                   EntryType::connection_test_ret,
                                   EntryType::get_node_info,
                                   EntryType::get_node_info_ret,
                                   EntryType::get_service_attributes_ret,
                                   EntryType::connect_client_combined_ret,
                                   EntryType::client_keep_alive_ret,
                                   EntryType::client_session_op_ret,
                                   EntryType::service_path_released_req,
                                   EntryType::property_get_res,
                                   EntryType::property_set_res,
                                   EntryType::function_call_res,
                                   EntryType::generator_next_res,
                                   EntryType::event_req,
                                   EntryType::pipe_packet,
                                   EntryType::pipe_packet_ret,
                                   EntryType::pipe_connect_ret,
                                   EntryType::pipe_disconnect_ret,
                                   EntryType::pipe_closed,
                                   EntryType::callback_call_req,
                                   EntryType::wire_packet,
                                   EntryType::wire_connect_ret,
                                   EntryType::wire_disconnect_ret,
                                   EntryType::wire_closed,
                                   EntryType::memory_read_ret,
                                   EntryType::memory_write_ret,
                                   EntryType::memory_get_param_ret,
                                   EntryType::wire_peek_in_value_ret,
                                   EntryType::wire_peek_out_value_ret,
                                   EntryType::wire_poke_out_value_ret};

// For terminals, for JSON, and what is no UTF-8.
constexpr std::array<std::string_view, 10> rude_texts = {"\x1b]0;title\x07\x1b[2J",
                                                         "\u202eabc\u200b",
                                                         "\xff\xfe\xc0\x80",
                                                         "\"quoted\\\"",
                                                         "line\nline\r\ttab",
                                                         "%s%n%d",
                                                         "</script>",
                                                         "experimental.fuzzed.",
                                                         "..[[%5d].",
                                                         ""};

constexpr std::array<std::string_view, 35> words = {
    "service",     "stdver",       "import",        "using",      "as",
    "struct",      "pod",          "namedarray",    "object",     "enum",
    "exception",   "end",          "field",         "property",   "function",
    "event",       "pipe",         "wire",          "memory",     "callback",
    "objref",      "constant",     "implements",    "varvalue",   "varobject",
    "double[]",    "string{list}", "int32{string}", "uint8[*]",   "cdouble[3,2]",
    "Tree{int32}", "Nothing[]",    "Wide[]",        "[readonly]", "double{generator}"};

constexpr std::array<std::string_view, 22> lines = {
    "import experimental.fuzzed",
    "import com.robotraconteur.geometry",
    "using experimental.fuzzed.Leaf as Tree",
    "struct Selfish\n    field Selfish me\nend",
    "pod Endless\n    field Endless me\nend",
    "pod Wide\n    field double[4000000000] all\nend",
    "pod Deep\n    field Wide[65535,65535,65535] all\nend",
    "pod Nothing\nend\nnamedarray None\nend",
    "    field Nothing[3] nothing",
    "enum Twice\n    one = 2147483648,\n    one = -1\nend",
    "object Root\n    implements Root\nend",
    "constant int32 limit 99999999999999999999",
    "constant string text \"\\u0000\\ud800\"",
    "constant double[] many {1e999,-0,nan}",
    "option constant int32 old 1",
    "stdver 9.9.9.9",
    "## documentation \x1b[31m",
    "    objref Root{int32} root",
    "    function void f(int32 a, int32 a)",
    "    function double{generator} g(double{generator} a, double{generator} b)",
    "    memory Tree[] trees",
    "    property Mode[-1] modes [perclient,urgent,nolock,unknown(1)]"};

constexpr std::array<std::string_view, 10> counts = {
    "0",     "1", "-1", "3-", "2147483647", "2147483648", "4294967296", "18446744073709551615",
    "65536", "*"};

// The mutations of messages want a function without a state of its own.
thread_local Random* byte_random = nullptr;

std::size_t mutate_bytes(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  Random& random = *byte_random;
  switch (random.below(4)) {
    case 0:  // another length
      size = random.below(std::min<std::size_t>(max_size, size + 8) + 1);
      break;
    case 1:
      if (size != 0) data[random.below(size)] ^= static_cast<std::uint8_t>(1U << random.below(8));
      break;
    case 2:
      if (size != 0) data[random.below(size)] = static_cast<std::uint8_t>(random.below(256));
      break;
    default: {
      constexpr std::array<std::uint8_t, 6> edges = {0x00, 0xff, 0x7f, 0x80, 0x01, 0x20};
      const std::size_t at = size == 0 ? 0 : random.below(size);
      const std::uint8_t edge = random.pick(edges);
      for (std::size_t i = at; i < std::min(size, at + 8); ++i) data[i] = edge;
      break;
    }
  }
  return size;
}

std::string_view view_of(const ElementTree& element) {
  return {reinterpret_cast<const char*>(element.payload.data()), element.payload.size()};
}

void set_text(ElementTree& element, std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  element.type = ElementType::string;
  element.elements.clear();
  element.payload.assign(begin, begin + std::min(text.size(), most_bytes));
}

ElementTree text_element(std::string_view name, std::string_view text) {
  ElementTree element = named_element(name, ElementType::string, {});
  set_text(element, text);
  return element;
}

void collect_texts(std::vector<ElementTree>& elements, std::vector<ElementTree*>& found) {
  for (ElementTree& element : elements) {
    if (element.type == ElementType::string) found.push_back(&element);
    collect_texts(element.elements, found);
  }
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string join(const std::vector<std::string>& parts, char separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i != 0) text += separator;
    text += parts[i];
  }
  return text;
}

}  // namespace

void AnswerMutation::mutate(MessageTree& message) {
  byte_random = &random_;
  if (message.entries.empty() || pool_->empty()) return;
  const std::uint32_t choice = random_.below(16);
  EntryTree& entry = random_.pick(message.entries);
  if (choice < 9) {
    MessageMutation(random_, mutate_bytes).mutate(message, random_.pick(*pool_));
  } else if (choice < 11) {
    mutate_question(entry);
  } else if (choice < 12) {
    mutate_error(entry);
  } else if (choice < 14) {
    grow(entry.elements);
  } else {
    mutate_texts(message);
  }
}

// What an answer belongs to, and whom something unasked is for.
void AnswerMutation::mutate_question(EntryTree& entry) {
  const MessageTree& other = random_.pick(*pool_);
  const EntryTree& source = random_.pick(other.entries);
  switch (random_.below(8)) {
    case 0:
      entry.type = random_.pick(to_clients);
      break;
    case 1:
      entry.request_id += random_.below(5) - 2;
      break;
    case 2:
      entry.request_id = random_.below(8);
      break;
    case 3:
      entry.service_path = source.service_path;
      break;
    case 4:
      entry.member = source.member;
      break;
    case 5:
      entry.elements = source.elements;
      break;
    case 6:
      entry.member = source.member;
      entry.elements = source.elements;
      break;
    default:
      entry.type = source.type;
      entry.elements = source.elements;
      break;
  }
}

void AnswerMutation::mutate_error(EntryTree& entry) {
  constexpr std::array<std::string_view, 6> names = {"experimental.fuzzed.ServiceFault",
                                                     "experimental.fuzzed.CalibrationError",
                                                     "RobotRaconteur.StopIterationException",
                                                     "RobotRaconteur.InvalidOperationException",
                                                     "x.y",
                                                     ""};
  entry.error =
      static_cast<std::uint16_t>(random_.one_in(4) ? random_.below(0x10000) : random_.below(160));
  entry.flags |= codec::entry_flag::error;
  if (random_.one_in(3)) return;
  entry.elements = {text_element("errorname", random_.pick(names)),
                    text_element("errorstring", random_.pick(rude_texts))};
  if (random_.one_in(2)) {
    entry.elements.push_back(text_element("errorsubname", random_.pick(rude_texts)));
    const MessageTree& other = random_.pick(*pool_);
    const std::vector<ElementTree>& elements = other.entries.front().elements;
    ElementTree parameter =
        elements.empty() ? text_element("", "parameter") : random_.pick(elements);
    parameter.name = "errorparam";
    entry.elements.push_back(std::move(parameter));
  }
}

// Many of what there is one of.
void AnswerMutation::grow(std::vector<ElementTree>& elements) {
  if (elements.empty()) return;
  ElementTree& element = random_.pick(elements);
  const std::size_t times = std::size_t{1} << random_.below(12);
  if (!element.elements.empty() && random_.one_in(2)) {
    grow(element.elements);
    return;
  }
  if (!element.payload.empty()) {
    const Bytes once = element.payload;
    for (std::size_t i = 1; i < times && element.payload.size() + once.size() < most_bytes; ++i) {
      element.payload.insert(element.payload.end(), once.begin(), once.end());
    }
    return;
  }
  // Of a list each has its number; what is not in a container has the same name again.
  std::vector<ElementTree>& all = element.elements.empty() ? elements : element.elements;
  ElementTree copy = random_.pick(all);
  const std::size_t weight = 64 + copy.payload.size() + copy.elements.size() * 64;
  const bool counts_up = !random_.one_in(4);
  for (std::size_t i = 0; i < times && all.size() < most_elements && i * weight < most_bytes; ++i) {
    if (counts_up) {
      copy.number = static_cast<std::int32_t>(all.size());
      if (!copy.name.empty()) copy.name = std::to_string(all.size());
    }
    all.push_back(copy);
  }
}

void AnswerMutation::mutate_texts(MessageTree& message) {
  byte_random = &random_;
  std::vector<ElementTree*> texts;
  for (EntryTree& entry : message.entries) collect_texts(entry.elements, texts);
  if (texts.empty()) {
    if (message.entries.empty()) return;
    std::string& text =
        random_.one_in(2) ? message.entries.front().member : message.entries.front().service_path;
    text.insert(random_.below(text.size() + 1), random_.pick(rude_texts));
    return;
  }
  mutate_text(*random_.pick(texts));
}

void AnswerMutation::mutate_text(ElementTree& element) {
  std::string text(view_of(element));
  if (text.find("\nobject ") != std::string::npos || text.starts_with("service ")) {
    set_text(element, mutate_definition(text, random_));
    return;
  }
  switch (random_.below(4)) {
    case 0:
      text.insert(random_.below(text.size() + 1), random_.pick(rude_texts));
      break;
    case 1:
      text = random_.pick(rude_texts);
      break;
    case 2: {
      std::vector<ElementTree*> others;
      MessageTree other = random_.pick(*pool_);
      for (EntryTree& entry : other.entries) collect_texts(entry.elements, others);
      if (!others.empty()) text = view_of(*random_.pick(others));
      break;
    }
    default: {
      const std::string once = text.empty() ? "x" : text;
      const std::size_t times = std::size_t{1} << random_.below(14);
      for (std::size_t i = 1; i < times && text.size() + once.size() < most_bytes; ++i)
        text += once;
      break;
    }
  }
  set_text(element, text);
}

std::string mutate_definition(const std::string& text, Random& random) {
  std::vector<std::string> all = split(text, '\n');
  const std::size_t at = random.below(all.size());
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(at);
  switch (random.below(10)) {
    case 0:
      all.erase(place);
      break;
    case 1: {
      std::string copy = all[random.below(all.size())];
      all.insert(place, std::move(copy));
      break;
    }
    case 2:
      std::swap(*place, all[random.below(all.size())]);
      break;
    case 3:
      all.insert(place, std::string(random.pick(lines)));
      break;
    case 4: {  // many
      const std::string line = all[at];
      const std::size_t times = std::size_t{1} << random.below(11);
      std::vector<std::string> more;
      for (std::size_t i = 0; i < times && i * (line.size() + 8) < most_bytes; ++i) {
        more.push_back(line + (random.one_in(2) ? "" : std::to_string(i)));
      }
      all.insert(place, more.begin(), more.end());
      break;
    }
    case 5:
      place->insert(random.below(place->size() + 1), random.pick(rude_texts));
      break;
    case 6: {  // a number
      const std::size_t digit = place->find_first_of("0123456789");
      const std::size_t bracket = place->find('[');
      if (digit != std::string::npos) {
        place->replace(digit, 1, random.pick(counts));
      } else if (bracket != std::string::npos) {
        place->insert(bracket + 1, random.pick(counts));
      }
      break;
    }
    default: {  // a word, by one of the language or of this definition
      std::vector<std::string> parts = split(*place, ' ');
      std::string& part = random.pick(parts);
      if (random.one_in(3)) {
        part = random.pick(words);
      } else {
        std::vector<std::string> others = split(all[random.below(all.size())], ' ');
        part = random.pick(others);
      }
      *place = join(parts, ' ');
      break;
    }
  }
  std::string changed = join(all, '\n');
  if (changed.size() > most_bytes) changed.resize(most_bytes);
  return changed;
}

}  // namespace rr::fuzz
