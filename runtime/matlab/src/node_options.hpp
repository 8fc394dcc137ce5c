// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include "rr/options.hpp"

namespace rr::matlab {

/// The options of a node from a struct of RobotRaconteur.SetNodeOptions: times in seconds. Throws
/// rr::Error that names the field.
NodeOptions read_node_options(const mxArray* given);

}  // namespace rr::matlab
