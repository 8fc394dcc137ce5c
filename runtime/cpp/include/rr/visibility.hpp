// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What shared libraries of the runtime show: the namespaces of public headers are marked with this
/// one, everything else is hidden.
#define RR_VISIBLE [[gnu::visibility("default")]]

/// For classes inside the runtime that one of its shared libraries has from another. No program may
/// use them: they change with every version.
#define RR_INSIDE [[gnu::visibility("default")]]
