// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Which optional fields a header of format 4 has (02, sections 2 to 4).
namespace rr::codec {

namespace message_flag {
inline constexpr std::uint8_t routing = 0x01;
inline constexpr std::uint8_t endpoints = 0x02;
inline constexpr std::uint8_t priority = 0x04;
inline constexpr std::uint8_t meta = 0x10;
inline constexpr std::uint8_t string_table = 0x20;
inline constexpr std::uint8_t multiple_entries = 0x40;
inline constexpr std::uint8_t extended = 0x80;
}  // namespace message_flag

namespace entry_flag {
inline constexpr std::uint8_t path_text = 0x01;
inline constexpr std::uint8_t path_code = 0x02;
inline constexpr std::uint8_t member_text = 0x04;
inline constexpr std::uint8_t member_code = 0x08;
inline constexpr std::uint8_t request_id = 0x10;
inline constexpr std::uint8_t error = 0x20;
inline constexpr std::uint8_t metadata = 0x40;
inline constexpr std::uint8_t extended = 0x80;
}  // namespace entry_flag

namespace element_flag {
inline constexpr std::uint8_t name_text = 0x01;
inline constexpr std::uint8_t name_code = 0x02;
inline constexpr std::uint8_t number = 0x04;
inline constexpr std::uint8_t type_name_text = 0x08;
inline constexpr std::uint8_t type_name_code = 0x10;
inline constexpr std::uint8_t metadata = 0x20;
inline constexpr std::uint8_t extended = 0x80;
}  // namespace element_flag

}  // namespace rr::codec
