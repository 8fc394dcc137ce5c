// SPDX-License-Identifier: Apache-2.0
// The names that templates use for the fields of the view.
#include "compiler/backends/arduino/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

ROBDEF_VIEW_TYPE(arduino::ParameterView, type, name);
ROBDEF_VIEW_TYPE(arduino::MemberView, number, can_get, can_set, has_result, is_indexed,
                 has_parameters, value_type, value_passed, parameters, declared, arguments, getter,
                 setter, hook, sender, field, child_first_plus, child_index, child_count,
                 child_class, child_find, slot_plus, slot_minus, slot_from, slot_end, doc,
                 hook_lines);
ROBDEF_VIEW_TYPE(arduino::GroupView, name, sender_class, handler, find, device, first_plus,
                 first_minus, end, parent_find, parent_index, own_index, hook, is_root, is_indexed,
                 is_several, uses_index, members);
ROBDEF_VIEW_TYPE(arduino::DeviceView, parameter, name, wire_name, doc, members);
ROBDEF_VIEW_TYPE(arduino::RecordView, name, doc, has_fields, fields);
ROBDEF_VIEW_TYPE(arduino::EnumView, name, doc, values);
ROBDEF_VIEW_TYPE(arduino::SpaceView, opening, closing, doc, constants, enums, records);
ROBDEF_VIEW_TYPE(arduino::TextView, name, literals);
ROBDEF_VIEW_TYPE(arduino::ServiceView, path, wire_name, class_name, qualified, spaces, own,
                 exceptions, groups, sends_wires, devices, root_device, template_parameters,
                 template_arguments, draft_arguments, texts, text_count, hash, request_size,
                 reply_size, out_size, queue_size, slots, slot_bytes, estimate);
ROBDEF_VIEW_TYPE(arduino::ModelView, services);

}  // namespace robdef
