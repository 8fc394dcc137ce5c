// SPDX-License-Identifier: Apache-2.0
// The names that templates use for the fields of the view.
#include "compiler/backends/cbus/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

#define FIELD(View, name) view_field<&cbus::View::name>(#name)

template <>
const ViewType& view_type<cbus::FieldView>() {
  static const ViewType type{FIELD(FieldView, wire_name),
                             FIELD(FieldView, name),
                             FIELD(FieldView, type),
                             FIELD(FieldView, dimension),
                             FIELD(FieldView, doc),
                             FIELD(FieldView, gap),
                             FIELD(FieldView, offset),
                             FIELD(FieldView, offset_four),
                             FIELD(FieldView, claim),
                             FIELD(FieldView, put),
                             FIELD(FieldView, get),
                             FIELD(FieldView, address),
                             FIELD(FieldView, count),
                             FIELD(FieldView, simulink_type),
                             FIELD(FieldView, simulink_dimensions),
                             FIELD(FieldView, complexity)};
  return type;
}
template <>
const ViewType& view_type<cbus::SignalView>() {
  static const ViewType type{FIELD(SignalView, name), FIELD(SignalView, path),
                             FIELD(SignalView, type), FIELD(SignalView, count),
                             FIELD(SignalView, place)};
  return type;
}
template <>
const ViewType& view_type<cbus::RecordView>() {
  static const ViewType type{
      FIELD(RecordView, wire_name),   FIELD(RecordView, c_name),    FIELD(RecordView, doc),
      FIELD(RecordView, is_bus),      FIELD(RecordView, fields),    FIELD(RecordView, gap),
      FIELD(RecordView, size),        FIELD(RecordView, size_four), FIELD(RecordView, bytes),
      FIELD(RecordView, frame_bytes), FIELD(RecordView, hash),      FIELD(RecordView, signal_count),
      FIELD(RecordView, signals)};
  return type;
}
template <>
const ViewType& view_type<cbus::DefinitionView>() {
  static const ViewType type{FIELD(DefinitionView, wire_name), FIELD(DefinitionView, prefix),
                             FIELD(DefinitionView, guard),     FIELD(DefinitionView, doc),
                             FIELD(DefinitionView, includes),  FIELD(DefinitionView, others),
                             FIELD(DefinitionView, records)};
  return type;
}
template <>
const ViewType& view_type<cbus::ModelView>() {
  static const ViewType type{FIELD(ModelView, definitions)};
  return type;
}

#undef FIELD

}  // namespace robdef
