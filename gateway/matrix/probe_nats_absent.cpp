// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "gateway/matrix/probe_broker.hpp"

namespace rr::gateway::matrix {

std::unique_ptr<ProbeBroker> make_nats_probe(const ProbeOptions&) {
  throw std::runtime_error("this was built without libnats");
}

}  // namespace rr::gateway::matrix
