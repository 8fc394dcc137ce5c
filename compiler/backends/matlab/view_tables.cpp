// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/backends/matlab/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

using namespace matlab;

template <>
const ViewType& view_type<ConstantView>() {
  static const ViewType type{
      view_field<&ConstantView::wire_name>("wire_name"), view_field<&ConstantView::name>("name"),
      view_field<&ConstantView::doc>("doc"), view_field<&ConstantView::value>("value")};
  return type;
}

template <>
const ViewType& view_type<EnumView>() {
  static const ViewType type{
      view_field<&EnumView::wire_name>("wire_name"), view_field<&EnumView::name>("name"),
      view_field<&EnumView::title>("title"), view_field<&EnumView::help>("help"),
      view_field<&EnumView::values>("values")};
  return type;
}

template <>
const ViewType& view_type<ExceptionView>() {
  static const ViewType type{
      view_field<&ExceptionView::wire_name>("wire_name"), view_field<&ExceptionView::name>("name"),
      view_field<&ExceptionView::title>("title"), view_field<&ExceptionView::help>("help"),
      view_field<&ExceptionView::identifier>("identifier")};
  return type;
}

template <>
const ViewType& view_type<FieldView>() {
  static const ViewType type{
      view_field<&FieldView::wire_name>("wire_name"), view_field<&FieldView::cpp_name>("cpp_name"),
      view_field<&FieldView::robdef_type>("robdef_type"), view_field<&FieldView::help>("help")};
  return type;
}

template <>
const ViewType& view_type<RecordView>() {
  static const ViewType type{view_field<&RecordView::wire_name>("wire_name"),
                             view_field<&RecordView::name>("name"),
                             view_field<&RecordView::qualified>("qualified"),
                             view_field<&RecordView::title>("title"),
                             view_field<&RecordView::help>("help"),
                             view_field<&RecordView::kind>("kind"),
                             view_field<&RecordView::is_namedarray>("is_namedarray"),
                             view_field<&RecordView::cpp>("cpp"),
                             view_field<&RecordView::number_type>("number_type"),
                             view_field<&RecordView::number_count>("number_count"),
                             view_field<&RecordView::fields>("fields"),
                             view_field<&RecordView::has_fields>("has_fields"),
                             view_field<&RecordView::constants>("constants"),
                             view_field<&RecordView::has_constants>("has_constants"),
                             view_field<&RecordView::constants_class>("constants_class")};
  return type;
}

template <>
const ViewType& view_type<ParameterView>() {
  static const ViewType type{view_field<&ParameterView::wire_name>("wire_name"),
                             view_field<&ParameterView::name>("name"),
                             view_field<&ParameterView::robdef_type>("robdef_type")};
  return type;
}

template <>
const ViewType& view_type<MemberView>() {
  static const ViewType type{view_field<&MemberView::wire_name>("wire_name"),
                             view_field<&MemberView::name>("name"),
                             view_field<&MemberView::async_name>("async_name"),
                             view_field<&MemberView::async_set_name>("async_set_name"),
                             view_field<&MemberView::title>("title"),
                             view_field<&MemberView::help>("help"),
                             view_field<&MemberView::property_doc>("property_doc"),
                             view_field<&MemberView::declaration>("declaration"),
                             view_field<&MemberView::kind>("kind"),
                             view_field<&MemberView::is_property>("is_property"),
                             view_field<&MemberView::is_function>("is_function"),
                             view_field<&MemberView::is_event>("is_event"),
                             view_field<&MemberView::is_objref>("is_objref"),
                             view_field<&MemberView::is_pipe>("is_pipe"),
                             view_field<&MemberView::is_callback>("is_callback"),
                             view_field<&MemberView::is_wire>("is_wire"),
                             view_field<&MemberView::is_memory>("is_memory"),
                             view_field<&MemberView::is_served>("is_served"),
                             view_field<&MemberView::can_get>("can_get"),
                             view_field<&MemberView::can_set>("can_set"),
                             view_field<&MemberView::is_readonly>("is_readonly"),
                             view_field<&MemberView::is_writeonly>("is_writeonly"),
                             view_field<&MemberView::is_unreliable>("is_unreliable"),
                             view_field<&MemberView::is_nolock>("is_nolock"),
                             view_field<&MemberView::is_nolockread>("is_nolockread"),
                             view_field<&MemberView::is_perclient>("is_perclient"),
                             view_field<&MemberView::is_urgent>("is_urgent"),
                             view_field<&MemberView::number>("number"),
                             view_field<&MemberView::robdef_type>("robdef_type"),
                             view_field<&MemberView::has_result>("has_result"),
                             view_field<&MemberView::is_generator>("is_generator"),
                             view_field<&MemberView::parameters>("parameters"),
                             view_field<&MemberView::has_parameters>("has_parameters"),
                             view_field<&MemberView::arguments>("arguments"),
                             view_field<&MemberView::arguments_behind>("arguments_behind"),
                             view_field<&MemberView::argument_cell>("argument_cell"),
                             view_field<&MemberView::has_index>("has_index"),
                             view_field<&MemberView::is_stream>("is_stream"),
                             view_field<&MemberView::object_class>("object_class"),
                             view_field<&MemberView::binding>("binding")};
  return type;
}

template <>
const ViewType& view_type<ObjectView>() {
  static const ViewType type{view_field<&ObjectView::wire_name>("wire_name"),
                             view_field<&ObjectView::short_name>("short_name"),
                             view_field<&ObjectView::name>("name"),
                             view_field<&ObjectView::qualified>("qualified"),
                             view_field<&ObjectView::title>("title"),
                             view_field<&ObjectView::help>("help"),
                             view_field<&ObjectView::stub>("stub"),
                             view_field<&ObjectView::stub_alias>("stub_alias"),
                             view_field<&ObjectView::table>("table"),
                             view_field<&ObjectView::constants>("constants"),
                             view_field<&ObjectView::has_constants>("has_constants"),
                             view_field<&ObjectView::members>("members"),
                             view_field<&ObjectView::has_members>("has_members"),
                             view_field<&ObjectView::has_properties>("has_properties"),
                             view_field<&ObjectView::has_methods>("has_methods")};
  return type;
}

template <>
const ViewType& view_type<DeclarationView>() {
  static const ViewType type{view_field<&DeclarationView::exception>("exception"),
                             view_field<&DeclarationView::enumeration>("enumeration"),
                             view_field<&DeclarationView::record>("record"),
                             view_field<&DeclarationView::object>("object")};
  return type;
}

template <>
const ViewType& view_type<DefinitionView>() {
  static const ViewType type{view_field<&DefinitionView::wire_name>("wire_name"),
                             view_field<&DefinitionView::definition_file>("definition_file"),
                             view_field<&DefinitionView::package>("package"),
                             view_field<&DefinitionView::folder>("folder"),
                             view_field<&DefinitionView::path>("path"),
                             view_field<&DefinitionView::space>("space"),
                             view_field<&DefinitionView::import_headers>("import_headers"),
                             view_field<&DefinitionView::import_packages>("import_packages"),
                             view_field<&DefinitionView::text>("text"),
                             view_field<&DefinitionView::constants>("constants"),
                             view_field<&DefinitionView::has_constants>("has_constants"),
                             view_field<&DefinitionView::declarations>("declarations"),
                             view_field<&DefinitionView::has_objects>("has_objects")};
  return type;
}

template <>
const ViewType& view_type<ModelView>() {
  static const ViewType type{view_field<&ModelView::client>("client"),
                             view_field<&ModelView::definitions>("definitions")};
  return type;
}

}  // namespace robdef
