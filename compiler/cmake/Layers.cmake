# SPDX-License-Identifier: Apache-2.0
# Who may include whom, and a reader of all #include lines that holds the tree to it.
#   cmake -D ROOT=<tree> -P compiler/cmake/Layers.cmake      (target check_layers, test layers)

# Folder: what its files may include besides the folder itself. The longest matching folder counts;
# an entry may be a folder or one file. A source in a folder without a row is a finding.
set(robdef_layers
  "compiler/diagnostics: compiler/output/json.hpp"
  "compiler/syntax: compiler/diagnostics compiler/output/json.hpp"
  "compiler/model: compiler/diagnostics compiler/syntax compiler/output/json.hpp"
  "compiler/output: compiler/diagnostics"
  "compiler/backends: compiler/diagnostics compiler/model compiler/output"
  # A sketch is C++ too: words and literals are the same.
  "compiler/backends/arduino: compiler/diagnostics compiler/model compiler/output compiler/backends/backend.hpp compiler/backends/check_values.hpp compiler/backends/implements.hpp compiler/backends/literals.hpp compiler/backends/print.hpp compiler/backends/words.hpp compiler/backends/cpp/constants.hpp compiler/backends/cpp/literal_text.hpp compiler/backends/cpp/names.hpp"
  "compiler/backends/cpp: compiler/diagnostics compiler/model compiler/output compiler/backends/backend.hpp compiler/backends/check_values.hpp compiler/backends/implements.hpp compiler/backends/literals.hpp compiler/backends/print.hpp compiler/backends/words.hpp"
  "compiler/backends/csharp: compiler/diagnostics compiler/model compiler/output compiler/backends/backend.hpp compiler/backends/check_values.hpp compiler/backends/implements.hpp compiler/backends/literals.hpp compiler/backends/print.hpp compiler/backends/words.hpp"
  # Uses generated code, which stands on the runtime.
  "compiler/backends/cpp/generated_test.cpp: compiler/model runtime/cpp/include/rr"
  "compiler/backends/cpp/generated_members_test.cpp: runtime/cpp/include/rr"
  "compiler/driver: compiler/diagnostics compiler/syntax compiler/model compiler/output compiler/backends runtime/cpp/include/rr runtime/cpp/src/replay"
  "compiler/driver/live/members_test.cpp: compiler/driver runtime/cpp/include/rr runtime/cpp/src/node/testing"
  "compiler/driver/live/session_test.cpp: compiler/driver runtime/cpp/include/rr runtime/cpp/src/node/testing"
  "compiler/driver/live/testing: compiler/driver runtime/cpp/include/rr runtime/cpp/src/node/testing"
  "compiler/driver/discover_test.cpp: compiler/driver runtime/cpp/include/rr runtime/cpp/src/node/testing runtime/cpp/src/discovery/testing.hpp"
  "compiler/driver/recordings_test.cpp: compiler/driver runtime/cpp/include/rr runtime/cpp/src/node/testing"

  "runtime/cpp/include/rr:"
  "runtime/cpp/src/codec: runtime/cpp/include/rr"
  "runtime/cpp/src/value: runtime/cpp/include/rr runtime/cpp/src/codec"
  "runtime/cpp/src/channel: runtime/cpp/include/rr runtime/cpp/src/codec"
  "runtime/cpp/src/endpoint: runtime/cpp/include/rr runtime/cpp/src/codec runtime/cpp/src/value runtime/cpp/src/channel"
  "runtime/cpp/src/client: runtime/cpp/include/rr runtime/cpp/src/codec runtime/cpp/src/value runtime/cpp/src/channel runtime/cpp/src/endpoint"
  "runtime/cpp/src/service: runtime/cpp/include/rr runtime/cpp/src/codec runtime/cpp/src/value runtime/cpp/src/channel runtime/cpp/src/endpoint"
  "runtime/cpp/src/subscription: runtime/cpp/include/rr runtime/cpp/src/channel runtime/cpp/src/endpoint runtime/cpp/src/client"
  "runtime/cpp/src/discovery: runtime/cpp/include/rr runtime/cpp/src/channel runtime/cpp/src/endpoint runtime/cpp/src/client runtime/cpp/src/subscription"
  "runtime/cpp/src/discovery/find_inside_test.cpp: runtime/cpp/include/rr runtime/cpp/src/discovery runtime/cpp/src/channel runtime/cpp/src/endpoint runtime/cpp/src/node/testing"
  "runtime/cpp/src/discovery/flood_inside_test.cpp: runtime/cpp/include/rr runtime/cpp/src/discovery runtime/cpp/src/channel runtime/cpp/src/endpoint runtime/cpp/src/node/testing"
  "runtime/cpp/src/discovery/local_nodes_inside_test.cpp: runtime/cpp/include/rr runtime/cpp/src/discovery runtime/cpp/src/channel runtime/cpp/src/node/testing"
  "runtime/cpp/src/discovery/type_subscription_test.cpp: runtime/cpp/include/rr runtime/cpp/src/discovery runtime/cpp/src/node/testing"
  "runtime/cpp/src/discovery/networks_test.cpp: runtime/cpp/src/node/testing"
  "runtime/cpp/src/discovery/peer.cpp: runtime/cpp/include/rr runtime/cpp/src/node/testing"
  "runtime/cpp/src/node: runtime/cpp/include/rr runtime/cpp/src/codec runtime/cpp/src/value runtime/cpp/src/channel runtime/cpp/src/endpoint runtime/cpp/src/client runtime/cpp/src/service runtime/cpp/src/subscription runtime/cpp/src/discovery"
  # The compiler's model reads definitions here too.
  "runtime/cpp/src/dynamic: runtime/cpp/include/rr runtime/cpp/src/codec runtime/cpp/src/value runtime/cpp/src/client compiler/diagnostics compiler/syntax compiler/model"
  "runtime/c: runtime/cpp/include/rr runtime/cpp/src/channel runtime/cpp/src/client runtime/cpp/src/endpoint runtime/cpp/src/service"
  "runtime/c/test: runtime/c/include runtime/cpp/include/rr runtime/cpp/src/node/testing runtime/cpp/src/client/definition_text.hpp"
  "runtime/matlab: runtime/cpp/include/rr"
  "runtime/matlab/test: runtime/cpp/include/rr runtime/cpp/src/dynamic/testing"
  "runtime/cpp/src/tap: runtime/cpp/include/rr"
  "runtime/cpp/src/replay: runtime/cpp/include/rr runtime/cpp/src/channel/capabilities.hpp runtime/cpp/src/channel/socket.hpp"
  "runtime/cpp/src/node/replay_test.cpp: runtime/cpp/include/rr runtime/cpp/src/node runtime/cpp/src/replay"
  "runtime/cpp/fuzz: runtime/cpp/include/rr runtime/cpp/src"
  "runtime/cpp/bench: runtime/cpp/include/rr runtime/cpp/src"
  "runtime/cpp/stress: runtime/cpp/include/rr runtime/cpp/src/node/testing"

  # Both ends of the protocol read its numbers from one file.
  "runtime/cpp/src/serial: runtime/cpp/include/rr runtime/cpp/src/dynamic runtime/arduino/src/rr/protocol.h"
  "runtime/arduino: runtime/cpp/src/serial runtime/cpp/include/rr runtime/cpp/src/node/testing"

  "conformance: runtime/cpp/include/rr runtime/cpp/src/replay"
  "conformance/runners/matlab: conformance runtime/cpp/include/rr runtime/matlab"
  "benchmarks: runtime/cpp/include/rr compiler"
  "examples: runtime/cpp/include/rr")

# Pattern of an outside header: the only folders or files that may include it. The parser's runtime and
# Asio each have one place where they can be exchanged.
set(robdef_outside_headers
  "^(antlr4|Robdef(Lexer|Parser))| compiler/syntax"
  "^boost/| runtime/cpp/include/rr/async.hpp runtime/cpp/src/channel/web_socket.cpp runtime/cpp/src/channel/memory_stream.hpp"
  "^openssl/| runtime/cpp/src/channel"
  "^rr/async\\.hpp$| runtime/cpp/src runtime/cpp/stress examples conformance benchmarks compiler/backends"
  "^(sys/epoll\\.h|sys/socket\\.h|netinet/|arpa/|netdb\\.h|poll\\.h)| runtime/cpp/src/serial runtime/cpp/src/channel runtime/cpp/src/discovery runtime/cpp/src/endpoint runtime/cpp/src/replay runtime/cpp/src/node/testing runtime/cpp/fuzz runtime/cpp/stress runtime/cpp/bench/fan_out_mosquitto.cpp conformance benchmarks"
  "^fmt/| compiler benchmarks"
  "^nlohmann/| runtime/cpp/fuzz/write_service_seeds.cpp runtime/cpp/src/codec/captures.hpp runtime/cpp/src/codec/captures.cpp runtime/cpp/src/value/capture_codec.hpp runtime/cpp/src/value/capture_values.hpp runtime/cpp/src/dynamic/json.cpp conformance"
  "^(mex\\.h|octave/)| runtime/matlab conformance/runners/matlab"
  "^histedit\\.h$| compiler/driver/live/line_reader.cpp"
  "^png\\.h$| examples")

# A name of a folder or file that `path` is or lies below.
function(robdef_is_below path folder result)
  string(FIND "${path}/" "${folder}/" at)
  if(at EQUAL 0)
    set(${result} TRUE PARENT_SCOPE)
  else()
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()

function(robdef_is_below_any path folders result)
  set(${result} FALSE PARENT_SCOPE)
  foreach(folder IN LISTS folders)
    robdef_is_below("${path}" "${folder}" is_below)
    if(is_below)
      set(${result} TRUE PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# The row of robdef_layers for a source: its folder and the allowed ones; empty when there is none.
function(robdef_layer_of source folder_result allowed_result)
  set(best "")
  set(best_allowed "")
  foreach(row IN LISTS robdef_layers)
    string(REGEX MATCH "^([^:]+):(.*)$" row "${row}")
    set(folder "${CMAKE_MATCH_1}")
    set(allowed "${CMAKE_MATCH_2}")
    robdef_is_below("${source}" "${folder}" is_below)
    string(LENGTH "${folder}" length)
    string(LENGTH "${best}" best_length)
    if(is_below AND length GREATER best_length)
      set(best "${folder}")
      string(STRIP "${allowed}" allowed)
      string(REPLACE " " ";" best_allowed "${allowed}")
    endif()
  endforeach()
  set(${folder_result} "${best}" PARENT_SCOPE)
  set(${allowed_result} "${best_allowed}" PARENT_SCOPE)
endfunction()

# What is wrong with `source` including `header`; empty when nothing is.
function(robdef_judge_include source header result)
  set(${result} "" PARENT_SCOPE)
  foreach(row IN LISTS robdef_outside_headers)
    string(REGEX MATCH "^(.*)\\| ([^|]*)$" row "${row}")
    set(pattern "${CMAKE_MATCH_1}")
    string(REPLACE " " ";" folders "${CMAKE_MATCH_2}")
    robdef_is_below_any("${source}" "${folders}" is_allowed)
    if(header MATCHES "${pattern}" AND NOT is_allowed AND NOT source MATCHES "_test\\.cpp$")
      set(${result} "only ${folders} may include it" PARENT_SCOPE)
      return()
    endif()
  endforeach()

  set(target "${header}")
  if(header MATCHES "^rr/")
    set(target "runtime/cpp/include/${header}")
  endif()
  robdef_is_below_any("${target}" "compiler;runtime;conformance;benchmarks;examples" is_ours)
  if(NOT is_ours)
    return()
  endif()
  robdef_layer_of("${source}" folder allowed)
  robdef_is_below_any("${target}" "${folder};${allowed}" is_allowed)
  if(NOT is_allowed)
    set(${result} "${folder} may include: ${allowed}" PARENT_SCOPE)
  endif()
endfunction()

# robdef_check_layers(ROOT RESULT): one line per finding, `file: includes header: why`.
function(robdef_check_layers root result)
  set(findings "")
  file(GLOB_RECURSE sources RELATIVE "${root}"
    "${root}/compiler/*.cpp" "${root}/compiler/*.hpp"
    "${root}/runtime/cpp/*.cpp" "${root}/runtime/cpp/*.hpp"
    "${root}/runtime/c/*.c" "${root}/runtime/c/*.cpp" "${root}/runtime/c/*.h" "${root}/runtime/c/*.hpp"
    "${root}/runtime/arduino/*.cpp" "${root}/runtime/arduino/*.hpp"
    "${root}/conformance/*.cpp" "${root}/conformance/*.hpp"
    "${root}/benchmarks/*.cpp" "${root}/benchmarks/*.hpp"
    "${root}/examples/*.cpp" "${root}/examples/*.hpp")
  # Goldens are written for users; the installed package's test stands for one.
  list(FILTER sources EXCLUDE REGEX "/golden/|^compiler/cmake/")
  foreach(source IN LISTS sources)
    robdef_layer_of("${source}" folder allowed)
    if(folder STREQUAL "")
      list(APPEND findings "${source}: its folder has no row in Layers.cmake")
      continue()
    endif()
    file(STRINGS "${root}/${source}" lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
    foreach(line IN LISTS lines)
      string(REGEX MATCH "[<\"]([^>\"]+)[>\"]" header "${line}")
      set(header "${CMAKE_MATCH_1}")
      robdef_judge_include("${source}" "${header}" why)
      if(NOT why STREQUAL "")
        list(JOIN why " " why)
        list(APPEND findings "${source}: includes ${header}: ${why}")
      endif()
    endforeach()
  endforeach()
  list(LENGTH sources count)
  if(count EQUAL 0)
    list(APPEND findings "${root}: there are no sources")
  endif()
  set(${result} "${findings}" PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  robdef_check_layers("${ROOT}" findings)
  foreach(finding IN LISTS findings)
    message("${finding}")
  endforeach()
  if(findings)
    message(FATAL_ERROR "includes against the layers")
  endif()
endif()
