// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/output/template.hpp"

namespace robdef::docs {

/// The files of templates/, compiled in.
TemplateSources embedded_templates();

}  // namespace robdef::docs
