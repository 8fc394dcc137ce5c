// SPDX-License-Identifier: Apache-2.0
// The steps of a plan that use pipes, wires, callbacks, memories and generators.
using System.Text.Json.Nodes;
using System.Threading;

namespace Robdef.Conformance;

internal sealed partial class CallingNode
{
    private JsonNode? PlayPipe(string operation, JsonObject step)
    {
        if (operation == "pipe_connect")
        {
            string name = Text(step, "as");
            PlannedPipe made = Object(step).Caller.Pipe(Text(step, "member"), step["index"]?.GetValue<int>() ?? -1, thing =>
            {
                thing["pipe"] = name;
                _arrivals.Add(thing);
            });
            _pipes[name] = made;
            return made.Index;
        }
        PlannedPipe pipe = _pipes[Text(step, "handle")];
        switch (operation)
        {
            case "pipe_send":
                return pipe.Send(step["value"], step["ack"]?.GetValue<bool>() ?? false);
            case "pipe_close":
                pipe.Close();
                return null;
            default:
                throw Unknown(operation);
        }
    }

    private JsonNode? PlayWire(string operation, JsonObject step)
    {
        PlannedWire wire = step.ContainsKey("handle") ? _wires[Text(step, "handle")] : Object(step).Caller.Wire(Text(step, "member"));
        switch (operation)
        {
            case "wire_connect":
                string name = Text(step, "as");
                wire.Connect(thing =>
                {
                    thing["wire"] = name;
                    _arrivals.Add(thing);
                });
                _wires[name] = wire;
                return null;
            case "wire_peek_in":
                return wire.PeekIn();
            case "wire_peek_out":
                return wire.PeekOut();
            case "wire_poke_out":
                wire.PokeOut(step["value"]);
                return null;
            case "wire_in":
                return wire.In();
            case "wire_set":
                wire.SetOut(step["value"]);
                return null;
            case "wire_close":
                wire.Close();
                return null;
            default:
                throw Unknown(operation);
        }
    }

    private JsonNode? PlayMemory(string operation, JsonObject step)
    {
        PlannedMemory memory = Object(step).Caller.Memory(Text(step, "member"));
        switch (operation)
        {
            case "mem_length":
                return memory.Length();
            case "mem_dims":
                return memory.Dims();
            case "mem_dimcount":
                return memory.DimCount();
            case "mem_read":
                return memory.Read(step["pos"]!, step["count"]!);
            case "mem_write":
                memory.Write(step["pos"]!, step["count"]!, step["value"]);
                return null;
            default:
                throw Unknown(operation);
        }
    }

    private JsonNode? PlayGenerator(string operation, JsonObject step)
    {
        if (operation == "gen_call")
        {
            _generators[Text(step, "as")] = Object(step).Caller.Generate(Text(step, "member"), step["args"]);
            return null;
        }
        PlannedGenerator generator = _generators[Text(step, "handle")];
        switch (operation)
        {
            case "gen_next":
                return generator.Next(step["value"]);
            case "gen_close":
                generator.Close();
                return null;
            case "gen_abort":
                generator.Abort();
                return null;
            default:
                throw Unknown(operation);
        }
    }

    private JsonNode? SetCallback(JsonObject step)
    {
        string member = Text(step, "member");
        JsonNode? outcomes = step["outcomes"];
        int calls = 0;
        Object(step).Caller.SetCallback(member, arguments =>
        {
            _arrivals.Add(new JsonObject { ["callback"] = member, ["args"] = arguments.DeepClone() });
            JsonNode? outcome = Outcomes.OfCall(outcomes, Interlocked.Increment(ref calls) - 1);
            return Json.Part(outcome, "throw") is { } error
                ? throw Outcomes.ExceptionOf(adapters, error, arguments)
                : Json.Part(outcome, "return");
        });
        return null;
    }
}
