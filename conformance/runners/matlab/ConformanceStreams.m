classdef ConformanceStreams < handle
  %CONFORMANCESTREAMS The steps of a plan that use pipes, wires, memories and generators, and what arrives by
  %   itself. Find(step), of the class below, gives the object of a step and what is known of its member.
  properties
    Handles   % what steps hold by a name: pipes, wires, generators
    Types     % of these, what is known of the member
    Closing   % ends that the plan closes itself
    Arrived   % in the notation of the captures
  end
  methods
    function result = PlayPipe(obj, step)
      result = [];
      if strcmp(step.op, 'pipe_connect')
        [target, member] = obj.Find(step);
        index = -1;
        if isfield(step, 'index')
          index = step.index;
        end
        pipe = target.(step.member).Connect(index);
        name = step.as;
        obj.Hold(name, pipe, member);
        addlistener(pipe, 'PacketReceived', @(packet) obj.Arrive('pipe', name, 'packet', ...
          conformance_mex('json', member.type, packet)));
        addlistener(pipe, 'PacketAckReceived', @(number) obj.Arrive('pipe', name, 'ack', double(number)));
        addlistener(pipe, 'PipeEndpointClosed', @() obj.Ended('pipe', name));
        result = double(pipe.Index);
        return
      end
      pipe = obj.Handles(step.handle);
      if strcmp(step.op, 'pipe_close')
        obj.Closing(step.handle) = true;
        pipe.Close();
        return
      end
      pipe.RequestPacketAck = isfield(step, 'ack') && step.ack;
      number = pipe.SendPacket(conformance_mex('value', obj.Types(step.handle).type, step.value));
      if ~pipe.IsUnreliable
        result = double(number);
      end
    end

    function result = PlayWire(obj, step)
      result = [];
      if isfield(step, 'handle')
        wire = obj.Handles(step.handle);
        member = obj.Types(step.handle);
        switch step.op
          case 'wire_in'
            result = conformance_mex('json', member.type, wire.InValue);
          case 'wire_set'
            wire.OutValue = conformance_mex('value', member.type, step.value);
          case 'wire_close'
            obj.Closing(step.handle) = true;
            wire.Close();
        end
        return
      end
      [target, member] = obj.Find(step);
      switch step.op
        case 'wire_peek_in'
          result = conformance_mex('json', member.type, target.(step.member).PeekInValue());
        case 'wire_peek_out'
          result = conformance_mex('json', member.type, target.(step.member).PeekOutValue());
        case 'wire_poke_out'
          target.(step.member).PokeOutValue(conformance_mex('value', member.type, step.value));
        case 'wire_connect'
          wire = target.(step.member).Connect();
          name = step.as;
          obj.Hold(name, wire, member);
          addlistener(wire, 'WireValueChanged', @(value, time) obj.Arrive('wire', name, 'value', ...
            conformance_mex('json', member.type, value)));
          addlistener(wire, 'WireConnectionClosed', @() obj.Ended('wire', name));
      end
    end

    function result = PlayMemory(obj, step)
      [target, member] = obj.Find(step);
      memory = target.(step.member);
      result = [];
      switch step.op
        case 'mem_length'
          result = sprintf('%d', memory.Length());
        case 'mem_dims'
          result = cellfun(@(dim) sprintf('%d', dim), num2cell(memory.Dimensions())', ...
                           'UniformOutput', false);
        case 'mem_dimcount'
          result = sprintf('%d', memory.DimCount());
        case 'mem_read'
          first = numbers_of(step.pos) + 1;
          count = numbers_of(step.count);
          if member.is_flat && count > 0
            items = memory(first:first + count - 1);
          else
            items = memory.Read(first, count);
          end
          result = conformance_mex('json', member.type, items);
        case 'mem_write'
          first = numbers_of(step.pos) + 1;
          count = numbers_of(step.count);
          if member.is_flat
            items = conformance_mex('value', member.type, step.value(1:count));
            memory(first:first + count - 1) = items;
          else
            memory.Write(first, conformance_mex('value', member.type, step.value));
          end
      end
    end

    function result = PlayGenerator(obj, step)
      result = [];
      if strcmp(step.op, 'gen_call')
        [target, member] = obj.Find(step);
        given = conformance_values(member.parameters, step.args);
        obj.Hold(step.as, target.(step.member)(given{:}), member);
        return
      end
      generator = obj.Handles(step.handle);
      member = obj.Types(step.handle);
      switch step.op
        case 'gen_next'
          given = {};
          if ~isempty(member.taken)
            given = {conformance_mex('value', member.taken, step.value)};
          end
          value = generator.Next(given{:});
          if ~isempty(member.type)
            result = conformance_mex('json', member.type, value);
          end
        case 'gen_close'
          generator.Close();
        case 'gen_abort'
          generator.Abort();
      end
    end

    function Hold(obj, name, thing, member)
      obj.Handles(name) = thing;
      obj.Types(name) = member;
    end

    function Ended(obj, kind, name)
      if ~isKey(obj.Closing, name)
        obj.Arrive(kind, name, 'closed', true);
      end
    end

    function Arrive(obj, varargin)
      thing = struct();
      for i = 1:2:numel(varargin)
        thing.(varargin{i}) = varargin{i + 1};
      end
      obj.Arrived{end + 1, 1} = thing;
    end
  end
end

function numbers = numbers_of(json)
if iscell(json)
  numbers = [json{:}];
else
  numbers = json;
end
end
