// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/wire_values.hpp"

#include <limits>

#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr::endpoint {
namespace {

// The same time with nanoseconds that are less than a second; the first or last one there is for
// what is beyond.
TimeSpec sound(TimeSpec time) {
  constexpr std::int32_t second = 1'000'000'000;
  std::int64_t carry = time.nanoseconds / second;
  time.nanoseconds %= second;
  if (time.nanoseconds < 0) {
    time.nanoseconds += second;
    --carry;
  }
  using Seconds = std::numeric_limits<std::int64_t>;
  if (!__builtin_add_overflow(time.seconds, carry, &time.seconds)) return time;
  return carry < 0 ? TimeSpec{Seconds::min(), 0} : TimeSpec{Seconds::max(), second - 1};
}

}  // namespace

void write_wire_value(Writer& writer, const Type& type, const void* value) {
  type.write(writer, "packet", value);
  if (writer.failed()) throw latched(writer);
}

void write_wire_time(Writer& writer, const TimeSpec& time) {
  type_of<TimeSpec>.write(writer, "packettime", &time);
}

void read_wire(const Message& message, const Entry& entry, const MemoryRef& owner,
               const TypeRegistry& types, const Type& type, TimeSpec& time, void* value) {
  Decoder decoder(message.version, &message.strings, owner, &types);
  read_wire(decoder, entry, type, time, value);
}

void read_wire(Decoder& decoder, const Entry& entry, const Type& type, TimeSpec& time,
               void* value) {
  const Parameter parameters[] = {{"packettime", &type_of<TimeSpec>}, {"packet", &type}};
  void* const places[] = {&time, value};
  read_values(decoder, entry, parameters, places);
  time = sound(time);
}

}  // namespace rr::endpoint
