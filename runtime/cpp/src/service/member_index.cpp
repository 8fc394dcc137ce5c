// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/member_index.hpp"

#include <bit>

namespace rr::service {
namespace {

std::size_t hash(std::string_view name) {  // FNV-1a: short names, and no seed needed
  std::uint64_t value = 14695981039346656037U;
  for (const char c : name) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return static_cast<std::size_t>(value ^ (value >> 32));
}

}  // namespace

MemberIndex::MemberIndex(const ObjectType& type)
    : type_(&type), slots_(std::bit_ceil(2 * type.members.size() + 1)) {
  for (std::size_t i = 0; i < type.members.size(); ++i) {
    std::size_t slot = hash(type.members[i].name);
    while (slots_[slot & (slots_.size() - 1)] != 0) ++slot;
    slots_[slot & (slots_.size() - 1)] = static_cast<std::uint16_t>(i + 1);
  }
}

std::optional<std::size_t> MemberIndex::find(std::string_view name) const {
  for (std::size_t slot = hash(name);; ++slot) {
    const std::uint16_t place = slots_[slot & (slots_.size() - 1)];
    if (place == 0) return std::nullopt;
    if (type_->members[place - 1U].name == name) return place - 1U;
  }
}

}  // namespace rr::service
