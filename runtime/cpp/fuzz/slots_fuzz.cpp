// SPDX-License-Identifier: Apache-2.0
// The memory of a wire, of a service that may have written anything to it: what is read from it is
// a value or is refused, and a value may be used while the service writes on.
#include <algorithm>
#include <cstring>
#include <mutex>
#include <span>
#include <vector>

#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/fuzz/published_copy.hpp"
#include "runtime/cpp/src/channel/shared_header.hpp"
#include "runtime/cpp/src/channel/shared_rings.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"

using rr::fuzz::promise;
using rr::fuzz::PublishedCopy;
using rr::fuzz::take_byte;

namespace {

using rr::channel::SlotHolds;
using rr::channel::SlotReader;
using rr::channel::SlotValue;
using rr::channel::SlotWriter;

constexpr std::size_t slots_at = rr::channel::SharedHeader::first_data;
// The number of the value, which is that of its slot.
constexpr std::size_t first_slot = 1;

rr::VarStringMap sample() {
  rr::VarStringMap value;
  value["name"] = std::string("arm");
  value["picture"] = rr::Array<std::uint8_t>(std::size_t{70'000});
  value["small"] = rr::Array<double>(std::size_t{20});
  value["trace"] = rr::Array<double>(std::size_t{9'000});
  value["flags"] = rr::Array<bool>(std::size_t{66'000});
  return value;
}

// One value, as a service has published it.
PublishedCopy published() {
  std::error_code error;
  const rr::VarStringMap value = sample();
  rr::Writer writer;
  writer.reset(rr::MessageVersion::v4);
  rr::endpoint::write_wire_value(writer, rr::type_of<rr::VarStringMap>, &value);
  rr::endpoint::write_wire_time(writer, {.seconds = 1, .nanoseconds = 2});
  const auto sizes = rr::channel::SlotSizes::for_value(writer.size());
  const auto slots = SlotWriter::make(sizes, 42, error);
  promise(slots != nullptr && slots->publish(writer.pieces(), writer.size(), 1),
          "there is a memory");
  return {slots->handle(), sizes.memory(), slots_at + (first_slot + 1) * sizes.slot};
}

// Places are within the words most of the time, or in the slot.
void overwrite(PublishedCopy& memory, std::span<const std::byte>& input) {
  const std::uint8_t where = take_byte(input);
  std::size_t at = take_byte(input) | std::size_t{take_byte(input)} << 8;
  if ((where & 0x80) != 0) {
    at += memory.used() - 0x10000 * std::size_t{1 + (where & 3U)};
  } else {
    at %= 0x300;
  }
  memory.write(input, where, at);
}

std::shared_ptr<SlotHolds::Words> hold_words() {
  std::error_code error;
  rr::platform::Descriptor handle;
  static const auto rings =
      rr::channel::SharedRings::make(rr::channel::SharedRings::smallest_ring, handle, error);
  return rings.holds();
}

// A value that was not overwritten is read in place.
void try_sample(PublishedCopy& memory, const std::shared_ptr<SlotHolds::Words>& words) {
  std::error_code error;
  memory.reset();
  const auto reader = SlotReader::open(memory.handle(), error);
  reader->use_holds(std::make_shared<SlotHolds>(words));
  SlotValue value;
  promise(reader->read(value) == SlotReader::Found::value && value.displaced.size() == 3,
          "the sample has three large arrays");
}

// Reads all that is in it.
void use(const rr::VarStringMap& value) {
  rr::Writer writer;
  writer.reset(rr::MessageVersion::v4);
  rr::endpoint::write_wire_value(writer, rr::type_of<rr::VarStringMap>, &value);
  std::size_t odd = 0;
  for (const rr::Piece& piece : writer.pieces()) {
    odd += static_cast<std::size_t>(std::count(piece.data, piece.data + piece.size, std::byte{1}));
  }
  static volatile std::size_t kept = 0;  // so that the bytes are read
  kept = odd;
  static_cast<void>(kept);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static PublishedCopy memory = published();
  static const auto words = hold_words();
  static const auto types = std::make_shared<const rr::TypeRegistry>();
  static std::once_flag is_tried;
  std::call_once(is_tried, [] { try_sample(memory, words); });
  std::span<const std::byte> input = rr::fuzz::input_of(data, size);
  const std::uint8_t mode = take_byte(input);
  memory.reset();
  for (int left = mode >> 4; left != 0 && !input.empty(); --left) overwrite(memory, input);
  std::error_code error;
  auto reader = SlotReader::open(memory.handle(), error);
  if (!reader) return 0;
  if ((mode & 1) != 0) reader->use_holds(std::make_shared<SlotHolds>(words));
  rr::VarStringMap made;
  for (int i = 0; i < 3; ++i) {
    SlotValue value;
    if (reader->read(value) == SlotReader::Found::value) {
      promise(value.bytes.size() <= reader->sizes().slot, "a value is in its slot");
      if (!input.empty()) overwrite(memory, input);
      rr::Entry entry;
      entry.elements = value.bytes;
      entry.element_count = rr::endpoint::wire_elements;
      rr::Decoder decoder(rr::MessageVersion::v4, nullptr, value.owner, types.get());
      decoder.set_displaced(value.displaced, value.slot);
      rr::TimeSpec time;
      rr::VarStringMap next;
      try {
        rr::endpoint::read_wire(decoder, entry, rr::type_of<rr::VarStringMap>, time, &next);
        made = std::move(next);
      } catch (const std::exception&) {
        // Another type, or none.
      }
    }
    while (!input.empty() && take_byte(input) % 4 != 0) overwrite(memory, input);
    use(made);
  }
  reader.reset();
  if ((mode & 2) != 0) use(made);
  made.clear();
  for (std::size_t slot = 0; slot < rr::channel::most_slots; ++slot) {
    promise(!words->are_used(slot), "what is not there any more uses no slot");
  }
  return 0;
}
