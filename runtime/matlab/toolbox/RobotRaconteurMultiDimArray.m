classdef RobotRaconteurMultiDimArray
  %ROBOTRACONTEURMULTIDIMARRAY An array of sizes that arrays of the interpreter do not keep.
  %   a = RobotRaconteurMultiDimArray(dims, array), as RobotRaconteurMultiDimArray([480 640 1], x).
  %   A value of type T[*] is received as one if it has no or one dimension, or ones at the end;
  %   others are arrays. It can be indexed, computed with and shown as an array is, and what comes
  %   of that is one: a(:, :, 1), a + 1, double(a). to_array(a) is an array of the same class.
  %   a.dims are its sizes, a.array its items in the order of the array, a column; numbers of
  %   namedarrays are in the columns of a matrix.
  properties (SetAccess = private)
    dims = [];
    array = [];
  end
  properties (Hidden, SetAccess = private)
    rr_numbers = 0;  % of each namedarray
  end
  methods
    function obj = RobotRaconteurMultiDimArray(dims, array, numbers)
      if nargin == 0
        return
      end
      if nargin < 2
        error('RobotRaconteur:InvalidArgument', 'an array is made of its sizes and its items');
      end
      obj.dims = double(dims(:).');
      count = 0;
      if ~isempty(obj.dims) && all(obj.dims ~= 0)
        count = prod(obj.dims);
      end
      if nargin < 3
        numbers = 0;
        if numel(array) ~= count && size(array, 2) == count
          numbers = size(array, 1);
        end
      end
      if numel(array) ~= count * max(numbers, 1)
        error('RobotRaconteur:InvalidArgument', 'expected %d items, got %d', count, numel(array));
      end
      obj.rr_numbers = double(numbers);
      if numbers == 0
        obj.array = rr_reshaped(array, [count, 1]);
      else
        obj.array = rr_reshaped(array, [numbers, count]);
      end
    end

    function items = to_array(obj)
      %TO_ARRAY As an array of the interpreter, which has two dimensions at least, and no ones at
      %   the end.
      items = rr_reshaped(obj.array, rr_all_sizes(obj));
    end

    function varargout = size(obj, varargin)
      %SIZE Length of each dimension.
      varargout = rr_sizes(rr_all_sizes(obj), max(nargout, 1), varargin{:});
    end
    function count = ndims(obj)
      %NDIMS How many dimensions it has.
      count = numel(rr_all_sizes(obj));
    end
    function count = numel(obj, varargin)
      % Octave asks this for each index, where it means one result.
      count = 1;
      if nargin == 1
        count = numel(obj.array);
      end
    end
    function count = length(obj)
      %LENGTH The longest dimension; 0 when there are no items.
      count = max(rr_all_sizes(obj)) * ~isempty(obj.array);
    end
    function count = rows(obj)
      %ROWS Length of the first dimension.
      count = size(obj, 1);
    end
    function count = columns(obj)
      %COLUMNS Length of the second dimension.
      count = size(obj, 2);
    end
    function answer = isempty(obj)
      %ISEMPTY Whether there are no items.
      answer = isempty(obj.array);
    end
    function count = numArgumentsFromSubscript(obj, s, context)
      % MATLAB asks for so many results of subsref; Octave does not call this.
      count = 1;
      if ~strcmp(char(context), 'Assignment')
        count = rr_result_count([], s);
      end
    end
    function last = end(obj, k, n)
      sizes = rr_all_sizes(obj);
      sizes(end + 1:n) = 1;
      last = sizes(k);
      if k == n
        last = prod(sizes(k:end));
      end
    end

    function varargout = subsref(obj, s)
      if strcmp(s(1).type, '.')
        [varargout{1:max(nargout, rr_result_count([], s))}] = builtin('subsref', obj, s);
      else
        [varargout{1:max(nargout, 1)}] = subsref(to_array(obj), s);
      end
    end
    function obj = subsasgn(obj, s, items)
      if strcmp(s(1).type, '.')
        error('RobotRaconteur:InvalidOperation', ...
              'sizes and items fit each other: make a new RobotRaconteurMultiDimArray');
      end
      changed = subsasgn(to_array(obj), s, rr_plain(items));
      sizes = size(changed);
      lead = double(obj.rr_numbers ~= 0);
      sizes(end + 1:numel(obj.dims) + lead) = 1;
      if numel(obj.dims) == 1 && lead == 0 && sum(sizes ~= 1) <= 1
        sizes = numel(changed);
      end
      obj = RobotRaconteurMultiDimArray(sizes(1 + lead:end), changed, obj.rr_numbers);
    end

    function answer = isequal(a, b, varargin)
      %ISEQUAL Whether dimensions and items are the same, of an ordinary array, too.
      answer = rr_apply(@isequal, a, b, varargin{:});
    end
    function disp(obj)
      fprintf('  %s %s\n\n', strjoin(arrayfun(@num2str, rr_all_sizes(obj), ...
                                              'UniformOutput', false), 'x'), class(obj.array));
      if ~isempty(obj.array)
        disp(to_array(obj));
      end
    end

    % To classes of numbers.
    function r = double(a), r = rr_apply(@double, a); end
    function r = single(a), r = rr_apply(@single, a); end
    function r = int8(a), r = rr_apply(@int8, a); end
    function r = uint8(a), r = rr_apply(@uint8, a); end
    function r = int16(a), r = rr_apply(@int16, a); end
    function r = uint16(a), r = rr_apply(@uint16, a); end
    function r = int32(a), r = rr_apply(@int32, a); end
    function r = uint32(a), r = rr_apply(@uint32, a); end
    function r = int64(a), r = rr_apply(@int64, a); end
    function r = uint64(a), r = rr_apply(@uint64, a); end
    function r = logical(a), r = rr_apply(@logical, a); end
    function r = isnumeric(a), r = isnumeric(a.array); end
    function r = isfloat(a), r = isfloat(a.array); end
    function r = isinteger(a), r = isinteger(a.array); end
    function r = islogical(a), r = islogical(a.array); end
    function r = isreal(a), r = isreal(a.array); end
    function r = iscomplex(a), r = ~isreal(a.array); end

    % What is computed is an array.
    function r = plus(a, b), r = rr_apply(@plus, a, b); end
    function r = minus(a, b), r = rr_apply(@minus, a, b); end
    function r = times(a, b), r = rr_apply(@times, a, b); end
    function r = mtimes(a, b), r = rr_apply(@mtimes, a, b); end
    function r = rdivide(a, b), r = rr_apply(@rdivide, a, b); end
    function r = mrdivide(a, b), r = rr_apply(@mrdivide, a, b); end
    function r = ldivide(a, b), r = rr_apply(@ldivide, a, b); end
    function r = mldivide(a, b), r = rr_apply(@mldivide, a, b); end
    function r = power(a, b), r = rr_apply(@power, a, b); end
    function r = mpower(a, b), r = rr_apply(@mpower, a, b); end
    function r = uminus(a), r = rr_apply(@uminus, a); end
    function r = uplus(a), r = rr_apply(@uplus, a); end
    function r = transpose(a), r = rr_apply(@transpose, a); end
    function r = ctranspose(a), r = rr_apply(@ctranspose, a); end
    function r = eq(a, b), r = rr_apply(@eq, a, b); end
    function r = ne(a, b), r = rr_apply(@ne, a, b); end
    function r = lt(a, b), r = rr_apply(@lt, a, b); end
    function r = le(a, b), r = rr_apply(@le, a, b); end
    function r = gt(a, b), r = rr_apply(@gt, a, b); end
    function r = ge(a, b), r = rr_apply(@ge, a, b); end
    function r = and(a, b), r = rr_apply(@and, a, b); end
    function r = or(a, b), r = rr_apply(@or, a, b); end
    function r = not(a), r = rr_apply(@not, a); end
    function r = real(a), r = rr_apply(@real, a); end
    function r = imag(a), r = rr_apply(@imag, a); end
    function r = conj(a), r = rr_apply(@conj, a); end
    function r = abs(a), r = rr_apply(@abs, a); end
    function r = round(a), r = rr_apply(@round, a); end
    function r = floor(a), r = rr_apply(@floor, a); end
    function r = ceil(a), r = rr_apply(@ceil, a); end
    function r = sqrt(a), r = rr_apply(@sqrt, a); end
    function r = isnan(a), r = rr_apply(@isnan, a); end
    function r = any(varargin), r = rr_apply(@any, varargin{:}); end
    function r = all(varargin), r = rr_apply(@all, varargin{:}); end
    function r = sum(varargin), r = rr_apply(@sum, varargin{:}); end
    function r = prod(varargin), r = rr_apply(@prod, varargin{:}); end
    function r = mean(varargin), r = rr_apply(@mean, varargin{:}); end
    function r = reshape(varargin), r = rr_apply(@reshape, varargin{:}); end
    function r = permute(varargin), r = rr_apply(@permute, varargin{:}); end
    function r = squeeze(a), r = rr_apply(@squeeze, a); end
    function varargout = min(varargin)
      [varargout{1:max(nargout, 1)}] = rr_apply(@min, varargin{:});
    end
    function varargout = max(varargin)
      [varargout{1:max(nargout, 1)}] = rr_apply(@max, varargin{:});
    end
    function varargout = find(varargin)
      [varargout{1:max(nargout, 1)}] = rr_apply(@find, varargin{:});
    end
    function varargout = imshow(varargin)
      [varargout{1:nargout}] = rr_apply(@imshow, varargin{:});
    end
    function varargout = image(varargin)
      [varargout{1:nargout}] = rr_apply(@image, varargin{:});
    end
    function varargout = imagesc(varargin)
      [varargout{1:nargout}] = rr_apply(@imagesc, varargin{:});
    end
    function imwrite(varargin), rr_apply(@imwrite, varargin{:}); end
  end
  methods (Access = private)
    function sizes = rr_all_sizes(obj)
      sizes = obj.dims;
      if obj.rr_numbers ~= 0
        sizes = [obj.rr_numbers, sizes];
      end
      if isempty(obj.dims)
        sizes(end + 1:2) = 0;  % as []
      end
      sizes(end + 1:2) = 1;
    end
  end
end

function varargout = rr_apply(work, varargin)
% What `work` gives for arrays in the place of objects of this class.
given = cellfun(@rr_plain, varargin, 'UniformOutput', false);
[varargout{1:nargout}] = work(given{:});
end

function items = rr_reshaped(items, sizes)
% Octave's reshape makes complex arrays real whose imaginary parts are all 0.
if isnumeric(items) && ~isreal(items)
  items = complex(reshape(real(items), sizes), reshape(imag(items), sizes));
else
  items = reshape(items, sizes);
end
end

function value = rr_plain(value)
if isa(value, 'RobotRaconteurMultiDimArray')
  value = to_array(value);
end
end
