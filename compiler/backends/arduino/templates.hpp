// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/output/template.hpp"

namespace robdef::arduino {

/// The files of templates/, compiled in; the definition is written by the build.
TemplateSources embedded_templates();

}  // namespace robdef::arduino
