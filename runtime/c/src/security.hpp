// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/options.hpp"
#include "rr/rights.hpp"
#include "runtime/c/include/rr.h"

namespace rr::capi {

// Each NULL: as a node or service has it without. Throw rr::Error.
TlsOptions read_tls(const rr_tls_options* given);
AuditOptions read_audit(const rr_audit_options* given);
std::shared_ptr<const Rights> read_rights(const rr_str* given);

}  // namespace rr::capi
