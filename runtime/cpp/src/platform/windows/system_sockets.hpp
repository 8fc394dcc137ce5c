// SPDX-License-Identifier: Apache-2.0
// The system's headers of sockets, for sources that are the same on all systems.
#pragma once

#include <winsock2.h>
// After it:
#include <afunix.h>
#include <ws2tcpip.h>
