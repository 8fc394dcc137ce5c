// SPDX-License-Identifier: Apache-2.0
// What a plan does with members that live longer than a call, whatever their types are.
using System;
using System.Linq;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>A connected pipe endpoint.</summary>
internal abstract class PlannedPipe
{
    public abstract JsonNode Index { get; }

    /// <summary>The packet's number; null where packets may be lost.</summary>
    public abstract JsonNode? Send(JsonNode? packet, bool isAcknowledged);

    public abstract void Close();
}

/// <summary>A wire; the last three need it to be connected.</summary>
internal abstract class PlannedWire
{
    public abstract JsonNode? PeekIn();

    public abstract JsonNode? PeekOut();

    public abstract void PokeOut(JsonNode? value);

    public abstract void Connect(Action<JsonObject> arrive);

    public abstract JsonNode? In();

    public abstract void SetOut(JsonNode? value);

    public abstract void Close();
}

internal abstract class PlannedMemory
{
    public abstract JsonNode Length();

    public abstract JsonNode Dims();

    public abstract JsonNode DimCount();

    /// <summary>Positions and counts are a number, or a list of them.</summary>
    public abstract JsonNode? Read(JsonNode position, JsonNode count);

    public abstract void Write(JsonNode position, JsonNode count, JsonNode? value);
}

/// <summary>A generator that was called.</summary>
internal abstract class PlannedGenerator(GeneratorBase generator)
{
    /// <summary>The parameter is null where none is taken; the result is where none is given. The end throws StopIteration.</summary>
    public abstract JsonNode? Next(JsonNode? parameter);

    public void Close() => generator.Close();

    public void Abort() => generator.Abort();

    protected static RobdefException End() => new(ErrorCode.StopIteration, "");
}

internal sealed class TypedPipe<T> : PlannedPipe
{
    private readonly Adapter<T> _adapter;
    private readonly PipeEndpoint<T> _end;
    private volatile bool _isClosing;

    public TypedPipe(Adapter<T> adapter, PipeEndpoint<T> end, Action<JsonObject> arrive)
    {
        _adapter = adapter;
        _end = end;
        end.SetHandler(
            packet => arrive(new JsonObject { ["packet"] = adapter.Write(packet) }),
            () =>
            {
                // An end that the plan closes itself has nothing to say about it.
                if (!_isClosing)
                {
                    arrive(new JsonObject { ["closed"] = true });
                }
            },
            number => arrive(new JsonObject { ["ack"] = number }));
    }

    public override JsonNode Index => _end.Index;

    public override JsonNode? Send(JsonNode? packet, bool isAcknowledged)
    {
        _end.AskForAcknowledgements(isAcknowledged);
        uint number = _end.Send(_adapter.Read(packet));
        return _end.IsUnreliable ? null : number;
    }

    public override void Close()
    {
        _isClosing = true;
        _end.Close();
    }
}

internal sealed class TypedWire<T>(Adapter<T> adapter, Wire<T> wire) : PlannedWire
{
    private WireConnection<T>? _end;
    private volatile bool _isClosing;

    public override JsonNode? PeekIn() => adapter.Write(wire.PeekInValue().Value);

    public override JsonNode? PeekOut() => adapter.Write(wire.PeekOutValueAsync().GetAwaiter().GetResult().Value);

    public override void PokeOut(JsonNode? value) => wire.PokeOutValue(adapter.Read(value));

    public override void Connect(Action<JsonObject> arrive)
    {
        _end = wire.Connect();
        _end.Closed += () =>
        {
            if (!_isClosing)
            {
                arrive(new JsonObject { ["closed"] = true });
            }
        };
        _end.ValueChanged += (value, _) => arrive(new JsonObject { ["value"] = adapter.Write(value) });
    }

    public override JsonNode? In() => adapter.Write(_end!.InValue);

    public override void SetOut(JsonNode? value) => _end!.OutValue = adapter.Read(value);

    public override void Close()
    {
        _isClosing = true;
        _end!.Close();
    }
}

internal sealed class TypedArrayMemory<T>(Adapter<T[]> adapter, ArrayMemory<T> memory) : PlannedMemory
{
    public override JsonNode Length() => Json.Text(memory.GetLength());

    public override JsonNode Dims() => new JsonArray(Length());

    public override JsonNode DimCount() => "1";

    public override JsonNode? Read(JsonNode position, JsonNode count)
    {
        var items = new T[Json.To<int>(count)];
        memory.Read(Json.To<long>(position), items);
        return adapter.Write(items);
    }

    public override void Write(JsonNode position, JsonNode count, JsonNode? value) =>
        memory.Write(Json.To<long>(position), adapter.Read(value).AsSpan(0, Json.To<int>(count)));
}

internal sealed class TypedMultiDimMemory<T>(Adapter<MultiDimArray<T>> adapter, MultiDimMemory<T> memory) : PlannedMemory
{
    public override JsonNode Length() => throw new RobdefException(ErrorCode.InvalidOperation, "It has dimensions");

    public override JsonNode Dims() => new JsonArray([.. memory.GetDims().Select(Json.Text)]);

    public override JsonNode DimCount() => Json.Text(memory.GetDimCount());

    public override JsonNode? Read(JsonNode position, JsonNode count)
    {
        long[] shape = Numbers(count);
        var array = new MultiDimArray<T>([.. shape.Select(dim => (int)dim)]);
        memory.Read(Numbers(position), shape, array.Items);
        return adapter.Write(array);
    }

    public override void Write(JsonNode position, JsonNode count, JsonNode? value) =>
        memory.Write(Numbers(position), Numbers(count), adapter.Read(value).Items);

    private static long[] Numbers(JsonNode list) => [.. Json.Items(list).Select(number => Json.To<long>(number!))];
}

internal sealed class TypedSource<T>(Adapter<T> adapter, Generator<T> generator) : PlannedGenerator(generator)
{
    private readonly Generator<T> _generator = generator;

    public override JsonNode? Next(JsonNode? parameter) => _generator.TryNext(out T value) ? adapter.Write(value) : throw End();
}

internal sealed class TypedSink<T>(Adapter<T> adapter, GeneratorSink<T> generator) : PlannedGenerator(generator)
{
    private readonly GeneratorSink<T> _generator = generator;

    public override JsonNode? Next(JsonNode? parameter) => _generator.TryNext(adapter.Read(parameter)) ? null : throw End();
}

internal sealed class TypedFilter<TIn, TOut>(Adapter<TIn> taken, Adapter<TOut> given, GeneratorFilter<TIn, TOut> generator) : PlannedGenerator(generator)
{
    private readonly GeneratorFilter<TIn, TOut> _generator = generator;

    public override JsonNode? Next(JsonNode? parameter)
    {
        (bool hasValue, TOut value) = _generator.NextAsync(taken.Read(parameter)).GetAwaiter().GetResult();
        return hasValue ? given.Write(value) : throw End();
    }
}
