// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/pipe_arrival.hpp"

#include "rr/type.hpp"

namespace rr::endpoint {

// False when the packet is not to be acknowledged.
bool PipeArrival::hand_to(const End& end, const PipePacket& packet) {
  const PipeEnd::State::Identity& what = end->identity;
  is_unreliable_ = what.is_unreliable;
  if (!end->may_receive()) return true;
  std::shared_ptr<void> value = what.holding->make();
  Decoder decoder(decoder_.version(), decoder_.strings(), decoder_.owner(), decoder_.types());
  if (!what.member->type->read(decoder, packet.value, value.get())) return false;
  if (!end->accept(packet.number, std::move(value), packet.size)) full_.push_back(end);
  if (last_ != end) {
    if (last_) others_.push_back(std::move(last_));
    last_ = end;
  }
  return true;
}

std::uint32_t PipeArrival::write_acknowledgements(Writer& writer) const {
  for (auto each = acknowledged_.rbegin(); each != acknowledged_.rend(); ++each) {
    write_acknowledgement(writer, each->first, each->second);
  }
  return static_cast<std::uint32_t>(acknowledged_.size());
}

void PipeArrival::deliver() {
  for (const End& end : others_) end->deliver();
  if (last_) last_->deliver();
  for (const End& end : full_) {
    if (const auto side = end->side()) side->close(*end, false);
  }
}

void for_each_acknowledgement(const Message& message, const Entry& entry,
                              const std::function<void(std::int32_t, std::uint32_t)>& function) {
  Decoder decoder(message.version, &message.strings);
  ElementReader elements(decoder, entry.elements, entry.element_count);
  for (Element element; elements.next(element);) {
    const auto index = element.index();
    std::uint32_t number = 0;
    if (index && read_number(element, number)) function(*index, number);
  }
}

}  // namespace rr::endpoint
