// SPDX-License-Identifier: Apache-2.0
// The system's headers of sockets, for sources that are the same on all systems.
#pragma once

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
