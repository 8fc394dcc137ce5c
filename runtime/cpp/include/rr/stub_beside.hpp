// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/client.hpp"
#include "rr/definition.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// One more stub for the object of another, in the same session: of generated code for an object of
/// rr::dynamic, say. Its time-out is the other's; its events and callbacks are its own. The object
/// must be of this type or implement it: the service is not asked, and calls of members that the
/// object has not fail. Throws rr::Error (invalid_operation) for a stub without a session.
std::shared_ptr<Stub> make_stub_beside(const Stub& stub, const ObjectType& type);

/// The same by the class.
template <class S>
std::shared_ptr<S> stub_beside(const Stub& stub) {
  return stub_cast<S>(make_stub_beside(stub, *type_of_stub<S>()));
}

}  // namespace rr
