// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/buffer.hpp"
#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/stub.hpp"

namespace rr {

/// An entry whose elements are values of a member.
struct Arguments::Source {
  const Message& message;
  const Entry& entry;
  const MemoryRef& owner;
  const TypeRegistry& types;
};

}  // namespace rr
