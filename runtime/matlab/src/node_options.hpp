// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include "rr/options.hpp"

namespace rr::matlab {

/// What RobotRaconteur.SetNodeOptions sets.
struct RuntimeOptions {
  NodeOptions node;
  /// Of all connections, see ConnectOptions.
  bool allow_clear_credentials = false;
};

/// From its struct: times in seconds. Throws rr::Error that names the field.
RuntimeOptions read_node_options(const mxArray* given);

}  // namespace rr::matlab
