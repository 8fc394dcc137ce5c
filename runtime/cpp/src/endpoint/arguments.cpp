// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/arguments.hpp"

#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr {

void Arguments::read(const Member& member, void* const* values) const {
  Decoder decoder(source_->message.version, &source_->message.strings, source_->owner,
                  &source_->types);
  endpoint::read_values(decoder, source_->entry, member.parameters, values);
}

}  // namespace rr
