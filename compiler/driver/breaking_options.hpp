// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/breaking/changes.hpp"

namespace robdef {

/// What `robdef breaking` is told besides the two versions.
struct BreakingOptions {
  enum class Form { text, json, github };

  breaking::Wanted wanted{.categories = {}, .allowed = {}};  ///< no categories: all
  Form form = Form::text;
};

}  // namespace robdef
