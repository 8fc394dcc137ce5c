// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "rr/dynamic_service.hpp"
#include "rr/node.hpp"

namespace rr::dynamic::testing {

inline constexpr const char* parts_text = R"(service example.parts

stdver 0.10

enum Mode
    idle = 0,
    busy = 5
end

struct Note
    field string text
    field double[] numbers
end

pod Sample
    field int16 id
    field double[3] at
end

namedarray Vector3
    field double x
    field double y
    field double z
end
)";

inline constexpr const char* rig_text = R"(service example.rig

stdver 0.10

import example.parts

using example.parts.Mode
using example.parts.Note
using example.parts.Sample
using example.parts.Vector3

exception Jam

object Named
    property string title [readonly]
end

object Child
    implements Named
    property string title [readonly]
    property int32 number
end

object Other
    property string label
end

object Rig
    property double speed
    property Note note
    property int32 mine [perclient]
    property Mode mode
    function double add(double a, double b)
    function void stop()
    function void jam(string text)
    function Note annotate(Note note, varvalue{list} more)
    function double{generator} count(double limit)
    function void collect(Note{generator} value)
    function double{generator} sum(double start, double{generator} value)
    event changed(Mode mode, Vector3 at)
    objref Child child
    objref Child[] by_index
    objref Named{string} by_name
    objref varobject{int32} anything
    pipe Sample[] samples
    callback Note ask(string question, Vector3 at)
    callback void ping()
    wire Vector3 force
    wire double level
    memory double[] buffer
    memory Sample[*] grid
    memory bool[] flags
    function void call_ping()
end
)";

inline const Definitions& rig_definitions() {
  static const Definitions definitions({rig_text, parts_text});
  return definitions;
}

/// A node that offers an object without generated code, and a client that has none either. The
/// parameter is the version of the messages, 2 or 4.
class Rigged : public ::testing::TestWithParam<int> {
 protected:
  explicit Rigged(ServedObject offered = ServedObject(rig_definitions(), "example.rig.Rig"))
      : rig(std::move(offered)), node(client_options()) {
    service = register_service(server, "rig", rig);
    url =
        "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) + "/?service=rig";
    client = connect(node, url);
  }

  static NodeOptions client_options() {
    NodeOptions options;
    options.client_offer.message_v4 = GetParam() == 4;
    return options;
  }

  ServedObject rig;
  Node server;
  Node node;
  Service service;
  std::string url;
  Client client;
};

}  // namespace rr::dynamic::testing
