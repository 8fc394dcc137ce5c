# SPDX-License-Identifier: Apache-2.0
# Holds the tree (ROOT) to its layers, then plants one forbidden include of each kind in a tree of
# its own (SCRATCH) and expects each to be found, and nothing else.
include(${ROOT}/compiler/cmake/Layers.cmake)

robdef_check_layers("${ROOT}" findings)
foreach(finding IN LISTS findings)
  message(SEND_ERROR "${finding}")
endforeach()

file(REMOVE_RECURSE "${SCRATCH}")
function(plant source header)
  file(WRITE "${SCRATCH}/${source}" "// SPDX-License-Identifier: Apache-2.0\n#include \"${header}\"\n")
endfunction()
set(forbidden
  "compiler/syntax/a.cpp|compiler/model/model.hpp"
  "compiler/backends/cpp/b.cpp|compiler/syntax/ast.hpp"
  "compiler/backends/cpp/c.cpp|compiler/backends/csharp/names.hpp"
  "compiler/model/d.cpp|antlr4-runtime.h"
  "compiler/backends/cpp/e.cpp|compiler/driver/options.hpp"
  "compiler/model/f.cpp|rr/value.hpp"
  "compiler/driver/n.cpp|rr/value.hpp"
  "compiler/driver/o.cpp|cli/commands.hpp"
  "runtime/cpp/src/codec/g.cpp|boost/asio.hpp"
  "runtime/cpp/src/codec/h.cpp|runtime/cpp/src/channel/tcp.hpp"
  "runtime/cpp/include/rr/i.hpp|runtime/cpp/src/codec/cursor.hpp"
  "runtime/cpp/include/rr/j.hpp|rr/async.hpp"
  "runtime/cpp/src/client/k.cpp|fmt/format.h"
  "runtime/cpp/src/client/l.cpp|runtime/cpp/src/service/dispatch.hpp")
foreach(row IN LISTS forbidden)
  string(REPLACE "|" ";" row "${row}")
  plant(${row})
endforeach()
plant(compiler/somewhere/m.cpp vector)
plant(compiler/driver/allowed.cpp compiler/model/model.hpp)
plant(runtime/cpp/src/platform/linux/allowed.cpp sys/epoll.h)
plant(runtime/cpp/src/channel/allowed_test.cpp sys/epoll.h)
plant(runtime/cpp/src/channel/testing/allowed.hpp poll.h)
plant(compiler/syntax/allowed.cpp antlr4-runtime.h)
plant(compiler/model/allowed_test.cpp compiler/output/json.hpp)

# What is of one system alone, above the platform seam.
set(of_one_system
  "channel/p.cpp|#include <unistd.h>"
  "discovery/q.cpp|#include <net/if.h>"
  "node/r.cpp|const int flags = MSG_DONTWAIT"
  "endpoint/s.cpp|// as epoll_wait() does"
  "tap/t.cpp|#ifdef _WIN32"
  "value/u.cpp|#if defined(__linux__)")
foreach(row IN LISTS of_one_system)
  string(REPLACE "|" ";" row "${row}")
  list(GET row 0 source)
  list(GET row 1 line)
  file(WRITE "${SCRATCH}/runtime/cpp/src/${source}" "${line}\n")
endforeach()
file(WRITE "${SCRATCH}/runtime/cpp/src/value/allowed.cpp" "#if defined(__SANITIZE_THREAD__)\n#endif\n")
file(WRITE "${SCRATCH}/runtime/cpp/src/platform/linux/allowed_too.cpp" "#ifdef MSG_ZEROCOPY\n")

robdef_check_layers("${SCRATCH}" findings)
list(LENGTH forbidden expected)
list(LENGTH of_one_system more)
math(EXPR expected "${expected} + ${more} + 1")
list(LENGTH findings found)
if(NOT found EQUAL expected)
  list(JOIN findings "\n" findings)
  message(SEND_ERROR "${found} of ${expected} planted faults were found:\n${findings}")
endif()
foreach(row IN LISTS forbidden)
  string(REPLACE "|" ";" row "${row}")
  list(POP_FRONT row source header)
  if(NOT "${findings}" MATCHES "${source}: includes ${header}:")
    message(SEND_ERROR "not found: ${header} in ${source}")
  endif()
endforeach()
foreach(row IN LISTS of_one_system)
  string(REPLACE "|" ";" row "${row}")
  list(GET row 0 source)
  if(NOT "${findings}" MATCHES "runtime/cpp/src/${source}: (includes|names|asks) [^:]*: that is for runtime/cpp/src/platform")
    message(SEND_ERROR "not found: what ${source} has of one system")
  endif()
endforeach()
if("${findings}" MATCHES "allowed")
  message(SEND_ERROR "an allowed include was reported:\n${findings}")
endif()
file(REMOVE_RECURSE "${SCRATCH}")
