// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include "runtime/cpp/src/codec/parse.hpp"

namespace rr {

[[gnu::hot]] std::optional<std::int32_t> Element::index() const {
  if (has_name) {
    std::string_view digits = name;
    // from_chars knows only the minus.
    if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
    std::int32_t value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc() && stop == digits.data() + digits.size()) return value;
  }
  if (has_number) return number;
  return std::nullopt;
}

void Decoder::set_budget(ContainerBudget& budget) {
  budget_ = &budget;
  reserved_ = 0;
}

[[gnu::hot]] bool Decoder::reserve_more(std::size_t bytes, std::string_view element) {
  if (budget_ != nullptr && budget_->draw(bytes)) return true;
  return fail(ErrorCode::out_of_system_resource,
              "the containers of the message need more memory than they may take", element);
}

Decoder::Located Decoder::locate_displaced(std::span<const std::byte> payload) const {
  const std::byte* const begin = payload.data();
  for (const DisplacedItems& one : displaced_) {
    const std::byte* const gap = one.gap.data();
    if (begin >= gap && begin + payload.size() <= gap + one.gap.size()) {
      return {{one.items + (begin - gap), payload.size()}, &displaced_owner_, true};
    }
  }
  return {payload, owner_ ? &owner_ : nullptr, false};
}

[[gnu::hot]] bool ElementReader::next(Element& element) {
  return decoder_->version() == MessageVersion::v4 ? next_v4(element) : next_v2(element);
}

bool ElementReader::next_v4(Element& element) {
  if (left_ == 0) return false;
  const std::byte* at = at_;
  const char* wrong =
      codec::parse_element_v4<codec::UnknownCode::refuse>(at, end_, decoder_->strings(), element);
  if (wrong != nullptr) [[unlikely]]
    return stop(wrong);
  at_ = at;
  --left_;
  return true;
}

bool ElementReader::next_v2(Element& element) {
  if (left_ == 0) return false;
  const std::byte* at = at_;
  const char* wrong = codec::parse_element_v2(at, end_, element);
  if (wrong != nullptr) [[unlikely]]
    return stop(wrong);
  at_ = at;
  --left_;
  return true;
}

bool ElementReader::stop(const char* wrong) {
  left_ = 0;
  return decoder_->fail(ErrorCode::protocol_error, wrong);
}

[[gnu::hot]] bool find_element(Decoder& decoder, std::span<const std::byte> bytes,
                               std::uint32_t count, std::string_view name, Element& element) {
  ElementReader reader(decoder, bytes, count);
  while (reader.next(element)) {
    if (element.has_name && element.name == name) return true;
  }
  return false;
}

}  // namespace rr
