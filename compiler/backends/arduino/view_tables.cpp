// SPDX-License-Identifier: Apache-2.0
// The names that templates use for the fields of the view.
#include "compiler/backends/arduino/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

#define FIELD(View, name) view_field<&arduino::View::name>(#name)

template <>
const ViewType& view_type<arduino::ParameterView>() {
  static const ViewType type{FIELD(ParameterView, type), FIELD(ParameterView, name)};
  return type;
}
template <>
const ViewType& view_type<arduino::MemberView>() {
  static const ViewType type{FIELD(MemberView, kind),           FIELD(MemberView, wire_name),
                             FIELD(MemberView, number),         FIELD(MemberView, is_property),
                             FIELD(MemberView, is_function),    FIELD(MemberView, is_event),
                             FIELD(MemberView, is_objref),      FIELD(MemberView, is_pipe),
                             FIELD(MemberView, is_callback),    FIELD(MemberView, is_wire),
                             FIELD(MemberView, can_get),        FIELD(MemberView, can_set),
                             FIELD(MemberView, has_result),     FIELD(MemberView, is_indexed),
                             FIELD(MemberView, has_parameters), FIELD(MemberView, value_type),
                             FIELD(MemberView, value_passed),   FIELD(MemberView, parameters),
                             FIELD(MemberView, declared),       FIELD(MemberView, arguments),
                             FIELD(MemberView, getter),         FIELD(MemberView, setter),
                             FIELD(MemberView, hook),           FIELD(MemberView, sender),
                             FIELD(MemberView, field),          FIELD(MemberView, child_first),
                             FIELD(MemberView, child_count),    FIELD(MemberView, child_class),
                             FIELD(MemberView, child_find),     FIELD(MemberView, slot),
                             FIELD(MemberView, slot_end),       FIELD(MemberView, doc),
                             FIELD(MemberView, hook_lines)};
  return type;
}
template <>
const ViewType& view_type<arduino::GroupView>() {
  static const ViewType type{
      FIELD(GroupView, name),       FIELD(GroupView, sender_class), FIELD(GroupView, handler),
      FIELD(GroupView, find),       FIELD(GroupView, device),       FIELD(GroupView, first),
      FIELD(GroupView, end),        FIELD(GroupView, parent_find),  FIELD(GroupView, fan),
      FIELD(GroupView, hook),       FIELD(GroupView, is_root),      FIELD(GroupView, is_indexed),
      FIELD(GroupView, is_several), FIELD(GroupView, members)};
  return type;
}
template <>
const ViewType& view_type<arduino::DeviceView>() {
  static const ViewType type{FIELD(DeviceView, parameter), FIELD(DeviceView, name),
                             FIELD(DeviceView, wire_name), FIELD(DeviceView, doc),
                             FIELD(DeviceView, members)};
  return type;
}
template <>
const ViewType& view_type<arduino::RecordView>() {
  static const ViewType type{FIELD(RecordView, name), FIELD(RecordView, doc),
                             FIELD(RecordView, fields)};
  return type;
}
template <>
const ViewType& view_type<arduino::EnumView>() {
  static const ViewType type{FIELD(EnumView, name), FIELD(EnumView, doc), FIELD(EnumView, values)};
  return type;
}
template <>
const ViewType& view_type<arduino::SpaceView>() {
  static const ViewType type{FIELD(SpaceView, opening), FIELD(SpaceView, closing),
                             FIELD(SpaceView, doc),     FIELD(SpaceView, constants),
                             FIELD(SpaceView, enums),   FIELD(SpaceView, records)};
  return type;
}
template <>
const ViewType& view_type<arduino::TextView>() {
  static const ViewType type{FIELD(TextView, name), FIELD(TextView, literals)};
  return type;
}
template <>
const ViewType& view_type<arduino::ServiceView>() {
  static const ViewType type{FIELD(ServiceView, path),
                             FIELD(ServiceView, wire_name),
                             FIELD(ServiceView, class_name),
                             FIELD(ServiceView, qualified),
                             FIELD(ServiceView, spaces),
                             FIELD(ServiceView, own),
                             FIELD(ServiceView, exceptions),
                             FIELD(ServiceView, groups),
                             FIELD(ServiceView, wires),
                             FIELD(ServiceView, devices),
                             FIELD(ServiceView, root_device),
                             FIELD(ServiceView, template_parameters),
                             FIELD(ServiceView, template_arguments),
                             FIELD(ServiceView, draft_arguments),
                             FIELD(ServiceView, texts),
                             FIELD(ServiceView, text_count),
                             FIELD(ServiceView, hash),
                             FIELD(ServiceView, request_size),
                             FIELD(ServiceView, reply_size),
                             FIELD(ServiceView, out_size),
                             FIELD(ServiceView, queue_size),
                             FIELD(ServiceView, slots),
                             FIELD(ServiceView, slot_bytes),
                             FIELD(ServiceView, estimate)};
  return type;
}
template <>
const ViewType& view_type<arduino::ModelView>() {
  static const ViewType type{FIELD(ModelView, services)};
  return type;
}

#undef FIELD

}  // namespace robdef
