function rr_check(c, name, given, wanted)
%RR_CHECK A property that is set to `given` is `wanted`, and so it is when it is set to that.
c.(name) = given;
got = c.(name);
assert(rr_isequal(got, wanted), 'as %s', evalc('display(got)'));
c.(name) = got;
assert(rr_isequal(c.(name), wanted));
end
