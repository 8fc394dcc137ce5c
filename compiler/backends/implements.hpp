// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

namespace robdef {

/// The implemented object from whose generated types a member comes. Null when there is none, and
/// when there are two that do not have it from a common one: then it is made anew.
const model::Object* origin(const model::Object& object, const std::string& name);

/// What its kind is called among those that are not served.
std::string plural_of(const model::Member& member);
/// Reports R0904 for a member that the runtime of `language` cannot serve.
void report_unserved(const model::Member& member, std::string_view language, Report& report);

/// The full name of a member as renames have it: of the object that declares it first, which may be
/// one that `object` implements.
std::string full_name(const model::Object& object, const model::Member& member);

}  // namespace robdef
