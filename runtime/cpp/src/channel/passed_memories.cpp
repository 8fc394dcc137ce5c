// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/passed_memories.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace rr::channel {
namespace {

template <class Reader>
Reader open_any(const platform::Descriptor& handle) {
  std::error_code error;
  if (auto slots = SlotReader::open(handle, error)) return slots;
  return PipeRingReader::open(handle, error);
}

}  // namespace

void PassedMemories::add(const platform::Descriptor& handle) {
  auto reader = open_any<Reader>(handle);
  const bool is_open = std::visit([](const auto& one) { return one != nullptr; }, reader);
  if (!is_open) return;
  if (readers_.size() == most) readers_.pop_front();
  readers_.push_back(std::move(reader));
}

template <class Kind>
std::unique_ptr<Kind> PassedMemories::take(std::uint64_t id) {
  const auto found = std::ranges::find_if(readers_, [&](const Reader& reader) {
    const auto* const one = std::get_if<std::unique_ptr<Kind>>(&reader);
    return one != nullptr && (*one)->id() == id;
  });
  if (found == readers_.end()) return nullptr;
  auto reader = std::get<std::unique_ptr<Kind>>(std::move(*found));
  readers_.erase(found);
  return reader;
}

std::unique_ptr<SlotReader> PassedMemories::take_slots(std::uint64_t id) {
  return take<SlotReader>(id);
}

std::unique_ptr<PipeRingReader> PassedMemories::take_ring(std::uint64_t id) {
  return take<PipeRingReader>(id);
}

}  // namespace rr::channel
