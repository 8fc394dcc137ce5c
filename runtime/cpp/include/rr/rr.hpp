// SPDX-License-Identifier: Apache-2.0
#pragma once

/// All that programs with generated code use of the core: nodes, clients, services, their members,
/// subscriptions, discovery and the command line of a node. Apart stay the headers of what is
/// linked besides: rr/dynamic.hpp, rr/serial.hpp, rr/realtime/*.hpp, and rr/async.hpp, which needs
/// Boost.

#include "rr/authority.hpp"
#include "rr/callbacks.hpp"
#include "rr/client.hpp"
#include "rr/discovery.hpp"
#include "rr/error.hpp"
#include "rr/generators.hpp"
#include "rr/intra.hpp"
#include "rr/locks.hpp"
#include "rr/member_subscription.hpp"
#include "rr/memories.hpp"
#include "rr/node.hpp"
#include "rr/options.hpp"
#include "rr/pipes.hpp"
#include "rr/recording.hpp"
#include "rr/rights.hpp"
#include "rr/service.hpp"
#include "rr/setup.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/subscription.hpp"
#include "rr/tap.hpp"
#include "rr/timer.hpp"
#include "rr/url.hpp"
#include "rr/users.hpp"
#include "rr/varvalue.hpp"
#include "rr/version.hpp"
#include "rr/wires.hpp"
