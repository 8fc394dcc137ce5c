// SPDX-License-Identifier: Apache-2.0
// The names that templates use for the fields of the view.
#include "compiler/backends/cbus/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

ROBDEF_VIEW_TYPE(cbus::FieldView, wire_name, name, type, dimension, doc, gap, offset, offset_four,
                 claim, put, get, address, count, simulink_type, simulink_dimensions, complexity);
ROBDEF_VIEW_TYPE(cbus::SignalView, name, path, type, count, place);
ROBDEF_VIEW_TYPE(cbus::RecordView, wire_name, c_name, doc, is_bus, fields, gap, size, size_four,
                 bytes, frame_bytes, hash, signal_count, signals);
ROBDEF_VIEW_TYPE(cbus::DefinitionView, wire_name, prefix, guard, doc, includes, others, records);
ROBDEF_VIEW_TYPE(cbus::ModelView, definitions);

}  // namespace robdef
