// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/read_lease.hpp"

namespace rr::channel {

template class BasicReadLease<Synchronization>;

}  // namespace rr::channel
