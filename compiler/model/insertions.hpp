// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// Lines that a help asks for, as changes of the file.
namespace robdef::model {

/// A new line `import <service>`: below the last import, else below version and service.
Replacement import_line(const Definition& user, const std::string& service);

/// A new line below the one of a place, with its indentation and the file's line end.
Replacement line_below(const Definition& user, Span at, const std::string& line);

}  // namespace robdef::model
