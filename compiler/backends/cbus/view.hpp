// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/output/view_type.hpp"

/// What templates can print of a definition in C. `robdef view --lang cbus` prints it all as JSON.
namespace robdef::cbus {

struct FieldView {
  std::string wire_name;
  std::string name;              ///< in C
  std::string type;              ///< `double`, `experimental_arm_Joint`
  std::string dimension;         ///< `[6]`, or empty
  std::vector<std::string> doc;  ///< lines within the comment's marks
  std::string gap;               ///< `uint8_t rr_gap_1[7];` before it, or empty
  std::string offset;            ///< in the struct where a double has 8 bytes
  std::string offset_four;       ///< where it has 4
  std::string claim;             ///< name of the check of its offset
  std::string put;               ///< `rr_bus_put_double`: writes such items
  std::string get;
  std::string address;              ///< of its first item, behind `bus->`: `q`, or `&` before it
  std::string count;                ///< of items
  std::string simulink_type;        ///< `double`, `Bus: experimental_arm_Joint`
  std::string simulink_dimensions;  ///< `[2 3]`, `6`, `1`
  std::string complexity;           ///< `real`, `complex`
};

/// A row of a bus's table.
struct SignalView {
  std::string name;  ///< `joints[2].angle`
  std::string path;  ///< the same in C
  std::string type;  ///< `RR_BUS_DOUBLE`
  std::string count;
  std::string place;  ///< in the packed bytes
};

/// A pod or namedarray.
struct RecordView {
  std::string wire_name;  ///< qualified: `experimental.arm.State`
  std::string c_name;     ///< `experimental_arm_State`
  std::vector<std::string> doc;
  bool is_bus = false;  ///< a pod; a namedarray is a part of one only
  std::vector<FieldView> fields;
  std::string gap;          ///< at its end, or empty
  std::string size;         ///< in memory where a double has 8 bytes
  std::string size_four;    ///< where it has 4
  std::string bytes;        ///< packed
  std::string frame_bytes;  ///< with the frame around it
  std::string hash;         ///< `0x0123456789ABCDEF`
  std::string signal_count;
  std::vector<SignalView> signals;
};

/// One service definition.
struct DefinitionView {
  std::string wire_name;  ///< `experimental.arm`
  std::string prefix;     ///< `experimental_arm`
  std::string guard;      ///< `EXPERIMENTAL_ARM_BUS_H`
  std::vector<std::string> doc;
  std::vector<std::string> includes;  ///< `experimental_joints_bus.h`
  std::vector<std::string>
      others;  ///< `experimental_joints_buses`: functions of the scripts of these
  std::vector<RecordView> records;  ///< each behind those that it contains
};

/// Everything that is generated for.
struct ModelView {
  std::vector<DefinitionView> definitions;
};

/// Builds the view. Reports R0901, R0903, R0930.
ModelView make_view(const model::Model& model, Report& report);

}  // namespace robdef::cbus
