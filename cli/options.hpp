// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/authority_options.hpp"
#include "cli/discover_options.hpp"
#include "cli/live_options.hpp"
#include "cli/recording_options.hpp"
#include "compiler/driver/options.hpp"

namespace robdef {

/// What the commands of this folder are told, beside what all are.
struct MoreOptions {
  RecordingOptions recording{};
  DiscoverOptions discover{};
  LiveOptions live{};
  AuthorityOptions authority{};
};

/// Those of a command line.
MoreOptions& more(Options& options);
const MoreOptions& more(const Options& options);

}  // namespace robdef
