// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/tap/credentials.hpp"

#include <algorithm>
#include <memory>
#include <string_view>

#include "rr/reader.hpp"

namespace rr::tap {
namespace {

constexpr std::string_view name = "credentials";
constexpr auto star = std::byte{'*'};

// The same bytes, which a reader sees as constant ones.
std::span<std::byte> within(std::span<std::byte> message, std::span<const std::byte> part) {
  if (part.empty()) return {};
  return message.subspan(static_cast<std::size_t>(part.data() - message.data()), part.size());
}

bool is_login(const Entry& entry) {
  return entry.type == EntryType::connect_client_combined ||
         entry.type == EntryType::client_session_op_req;
}

class Mask {
 public:
  explicit Mask(std::span<std::byte> message) : message_(message) {}

  // False when the message cannot be read.
  bool apply() {
    const auto read = std::make_unique<Message>();
    const Limits limits{.message_size = static_cast<std::uint32_t>(message_.size())};
    if (!read_message(message_, limits, true, *read, nullptr)) return false;
    Decoder decoder(read->version, &read->strings);
    EntryReader entries(*read);
    for (Entry entry; entries.next(entry);) {
      if (is_login(entry)) mask_entry(decoder, entry);
    }
    return true;
  }

 private:
  void mask_entry(Decoder& decoder, const Entry& entry) {
    ElementReader elements(decoder, entry.elements, entry.element_count);
    for (Element element; elements.next(element);) {
      if (element.name == name) mask_element(decoder, element);
    }
  }

  void mask_element(Decoder& decoder, const Element& element) {
    std::ranges::fill(within(message_, element.extended), std::byte{});
    fill_text(element.metadata);
    if (!is_nested(element.type)) {
      std::ranges::fill(within(message_, element.payload),
                        element.type == ElementType::string ? star : std::byte{});
      return;
    }
    ElementReader nested(decoder, element);
    for (Element each; nested.next(each);) mask_element(decoder, each);
  }

  void fill_text(std::string_view text) {
    std::ranges::fill(within(message_, std::as_bytes(std::span(text.data(), text.size()))), star);
  }

  const std::span<std::byte> message_;
};

}  // namespace

void mask_credentials(std::span<std::byte> message) {
  if (Mask(message).apply()) return;
  const auto* const text = reinterpret_cast<const char*>(message.data());
  const std::size_t at = std::string_view(text, message.size()).find(name);
  if (at != std::string_view::npos) std::ranges::fill(message.subspan(at + name.size()), star);
}

}  // namespace rr::tap
