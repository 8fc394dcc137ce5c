function result = conformance_pass(value)
%CONFORMANCE_PASS A value as the interpreter's user may have kept it: in a cell, in a field.
kept = {value};
record = struct();
record.field = kept{1};
result = record.field;
end
