// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/capabilities.hpp"

#include <array>
#include <cstring>
#include <utility>

namespace rr::channel {
namespace {

constexpr std::uint32_t page_mask = 0xFFF00000;

constexpr std::uint32_t message2_page = 0x02000000;
constexpr std::uint32_t message4_page = 0x04000000;
constexpr std::uint32_t strings_page = 0x04100000;

// The first flag of every page.
constexpr std::uint32_t enable_flag = 0x1;
// Of the message pages.
constexpr std::uint32_t combined_flag = 0x2;
// Of the string table page.
constexpr std::uint32_t local_strings_flag = 0x2;
constexpr std::uint32_t standard_strings_flag = 0x4;

struct Pages {
  std::optional<std::uint32_t> message2;
  std::optional<std::uint32_t> message4;
  std::optional<std::uint32_t> strings;
};

// The flags of each page, the first mention counting; unknown pages are left out.
Pages read_pages(std::span<const std::uint32_t> codes) {
  Pages pages;
  const auto take = [](std::optional<std::uint32_t>& page, std::uint32_t code) {
    if (!page) page = code & ~page_mask;
  };
  for (const std::uint32_t code : codes) {
    switch (code & page_mask) {
      case message2_page:
        take(pages.message2, code);
        break;
      case message4_page:
        take(pages.message4, code);
        break;
      case strings_page:
        take(pages.strings, code);
        break;
      default:
        break;
    }
  }
  return pages;
}

// The flags that a side lets be set on each page.
Pages allowed_flags(const Offer& offer) {
  const std::uint32_t message_flags = enable_flag | (offer.combined_connect ? combined_flag : 0);
  Pages pages;
  pages.message2 = message_flags;
  if (offer.message_v4) pages.message4 = message_flags;
  if (offer.message_v4 && offer.string_table) {
    pages.strings = enable_flag | local_strings_flag | standard_strings_flag;
  }
  return pages;
}

std::vector<std::uint32_t> as_codes(const Pages& pages) {
  std::vector<std::uint32_t> codes;
  if (pages.message2) codes.push_back(message2_page | *pages.message2);
  if (pages.message4) codes.push_back(message4_page | *pages.message4);
  if (pages.strings) codes.push_back(strings_page | *pages.strings);
  return codes;
}

Agreement as_agreement(const Pages& pages) {
  const bool is_v4 = pages.message4.value_or(0) & enable_flag;
  const std::uint32_t message_flags = is_v4 ? *pages.message4 : pages.message2.value_or(0);
  const std::uint32_t string_flags = pages.strings.value_or(0);
  const bool has_strings = string_flags & enable_flag;
  return {is_v4 ? MessageVersion::v4 : MessageVersion::v2, (message_flags & combined_flag) != 0,
          has_strings && (string_flags & local_strings_flag) != 0,
          has_strings && (string_flags & standard_strings_flag) != 0};
}

// What is both asked for and allowed, when the page is enabled by both.
std::optional<std::uint32_t> common(std::optional<std::uint32_t> a,
                                    std::optional<std::uint32_t> b) {
  const std::uint32_t flags = a.value_or(0) & b.value_or(0);
  if ((flags & enable_flag) == 0) return std::nullopt;
  return flags;
}

bool is_within(std::optional<std::uint32_t> flags, std::optional<std::uint32_t> allowed) {
  return (flags.value_or(0) & ~allowed.value_or(0)) == 0;
}

}  // namespace

std::vector<std::uint32_t> offered_codes(const Offer& offer) {
  return as_codes(allowed_flags(offer));
}

std::optional<ServerAnswer> answer_codes(std::span<const std::uint32_t> requested,
                                         const Offer& offer) {
  const Pages request = read_pages(requested);
  const Pages allowed = allowed_flags(offer);
  if (request.message2 && (*request.message2 & enable_flag) == 0) return std::nullopt;
  Pages answer;
  answer.message2 = request.message2 ? *request.message2 & *allowed.message2 : enable_flag;
  answer.message4 = common(request.message4, allowed.message4);
  if (answer.message4) answer.strings = common(request.strings, allowed.strings);
  return ServerAnswer{as_codes(answer), as_agreement(answer)};
}

std::optional<Agreement> agree(std::span<const std::uint32_t> answered, const Offer& offered) {
  const Pages answer = read_pages(answered);
  const Pages allowed = allowed_flags(offered);
  if ((answer.message2.value_or(0) & enable_flag) == 0) return std::nullopt;
  if (!is_within(answer.message2, allowed.message2) ||
      !is_within(answer.message4, allowed.message4) ||
      !is_within(answer.strings, allowed.strings)) {
    return std::nullopt;
  }
  const bool is_v4 = (answer.message4.value_or(0) & enable_flag) != 0;
  if (answer.strings.value_or(0) != 0 && !is_v4) return std::nullopt;
  return as_agreement(answer);
}

std::optional<std::vector<std::uint32_t>> read_codes(const Element& element) {
  if (element.type != ElementType::uint32) return std::nullopt;
  std::vector<std::uint32_t> codes(element.payload.size() / sizeof(std::uint32_t));
  if (!codes.empty()) {
    std::memcpy(codes.data(), element.payload.data(), codes.size() * sizeof(std::uint32_t));
  }
  return codes;
}

std::uint32_t stream_capability(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, std::uint32_t>, 8> levels = {{
      {"com.robotraconteur.message.v_max", 4},
      {"com.robotraconteur.v2", 1},
      {"com.robotraconteur.v2.0", 1},
      {"com.robotraconteur.message.v4", 1},
      {"com.robotraconteur.message.v4.0", 1},
      {"com.robotraconteur.stringtable", 4},
      {"com.robotraconteur.stringtable.v4", 1},
      {"com.robotraconteur.stringtable.v4.0", 1},
  }};
  for (const auto& [known, level] : levels) {
    if (known == name) return level;
  }
  return 0;  // also the minor numbers, which are all 0
}

}  // namespace rr::channel
