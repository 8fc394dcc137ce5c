// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// A generator of a service. Steps may be made from any thread; the service takes them one after
/// the other. Disposed before its end it is closed, without waiting.
/// </summary>
public abstract class GeneratorBase : IDisposable
{
    private readonly GeneratorHandle _handle;
    private readonly ObjectHandle _object;

    internal GeneratorBase(GeneratorHandle handle, ObjectHandle target)
    {
        _handle = handle;
        _object = target;
    }

    /// <summary>No more steps are wanted.</summary>
    public void Close(CancellationToken cancel = default) => End(0, cancel);

    /// <summary>The service is to break off.</summary>
    public void Abort(CancellationToken cancel = default) => End(1, cancel);

    /// <summary>No more steps are wanted.</summary>
    public Task CloseAsync(CancellationToken cancel = default) => EndAsync(0, cancel);

    /// <summary>The service is to break off.</summary>
    public Task AbortAsync(CancellationToken cancel = default) => EndAsync(1, cancel);

    /// <summary>Lets go of the generator.</summary>
    public void Dispose()
    {
        _handle.Dispose();
        GC.SuppressFinalize(this);
    }

    /// <summary>One step; false at the end.</summary>
    private protected unsafe bool Step<TIn, TOut>(ValueCodec<TIn>? taken, TIn parameter, ValueCodec<TOut>? given, out TOut value,
        CancellationToken cancel)
    {
        var cancellation = new NativeCancellation(cancel);
        ElementWriter writer = Writers.Rent(_object.Version);
        taken?.Write(writer, "parameter"u8, parameter);
        fixed (byte* first = writer.Written)
        {
            cancellation.Begin();
            RrElements elements = Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = cancellation.Handle };
            nint error;
            int status = Functions.rr_generator_next(_handle, taken is null ? null : &elements, &options, out nint data, &error);
            cancellation.End();
            Writers.Return(writer);
            value = default!;
            if (status == (int)ErrorCode.StopIteration && error == 0)
            {
                return false;
            }
            if (status != 0)
            {
                throw cancellation.Failed(Failure.Take(status, error, _object.Types));
            }
            if (given is null)
            {
                Functions.rr_data_release(data);
            }
            else
            {
                value = Elements.Take(data, given, _object.Types.Registry);
            }
            return true;
        }
    }

    /// <summary>One step; no value at the end.</summary>
    private protected unsafe Task<(bool HasValue, TOut Value)> StepAsync<TIn, TOut>(ValueCodec<TIn>? taken, TIn parameter,
        ValueCodec<TOut>? given, CancellationToken cancel)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<(bool, TOut)>(cancel);
        }
        KnownTypes types = _object.Types;
        var completion = new TaskCompletion<(bool, TOut)>(types, data =>
        {
            if (data == 0)
            {
                return (false, default!);
            }
            if (given is not null)
            {
                return (true, Elements.Take(data, given, types.Registry));
            }
            Functions.rr_data_release(data);
            return (true, default!);
        }, cancel);
        ElementWriter writer = Writers.Rent(_object.Version);
        taken?.Write(writer, "parameter"u8, parameter);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
            RrCompletion native = completion.Native;
            nint error;
            int status = Functions.rr_generator_next_async(_handle, taken is null ? null : &elements, &options, &native, &error);
            Writers.Return(writer);
            return status == 0 ? completion.Task : Task.FromException<(bool, TOut)>(completion.Abandon(native, status, error));
        }
    }

    private unsafe void End(int aborts, CancellationToken cancel)
    {
        var cancellation = new NativeCancellation(cancel);
        cancellation.Begin();
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = cancellation.Handle };
        nint error;
        int status = Functions.rr_generator_end(_handle, aborts, &options, &error);
        cancellation.End();
        if (status != 0)
        {
            throw cancellation.Failed(Failure.Take(status, error, _object.Types));
        }
    }

    private unsafe Task EndAsync(int aborts, CancellationToken cancel)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled(cancel);
        }
        var completion = new TaskCompletion<bool>(_object.Types, static _ => true, cancel);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status = Functions.rr_generator_end_async(_handle, aborts, &options, &native, &error);
        return status == 0 ? completion.Task : Task.FromException(completion.Abandon(native, status, error));
    }
}

/// <summary>A generator that gives values.</summary>
/// <typeparam name="T">What each step gives.</typeparam>
public sealed class Generator<T> : GeneratorBase, IAsyncEnumerable<T>
{
    private readonly ValueCodec<T> _codec;

    internal Generator(GeneratorHandle handle, ObjectHandle target, ValueCodec<T> codec)
        : base(handle, target) => _codec = codec;

    /// <summary>The next value, read in the thread of the caller; false at the end.</summary>
    public bool TryNext(out T value, CancellationToken cancel = default) => Step<bool, T>(null, false, _codec, out value, cancel);

    /// <summary>The next value; none at the end.</summary>
    public Task<(bool HasValue, T Value)> NextAsync(CancellationToken cancel = default) => StepAsync<bool, T>(null, false, _codec, cancel);

    /// <summary>All values that are left. Leaving the loop early closes the generator.</summary>
    public async IAsyncEnumerator<T> GetAsyncEnumerator(CancellationToken cancellationToken = default)
    {
        try
        {
            while (true)
            {
                (bool hasValue, T value) = await NextAsync(cancellationToken).ConfigureAwait(false);
                if (!hasValue)
                {
                    yield break;
                }
                yield return value;
            }
        }
        finally
        {
            Dispose();
        }
    }
}

/// <summary>A generator that takes values.</summary>
/// <typeparam name="T">What each step takes.</typeparam>
public sealed class GeneratorSink<T> : GeneratorBase
{
    private readonly ValueCodec<T> _codec;

    internal GeneratorSink(GeneratorHandle handle, ObjectHandle target, ValueCodec<T> codec)
        : base(handle, target) => _codec = codec;

    /// <summary>Gives a value, in the thread of the caller; false when no more are taken.</summary>
    public bool TryNext(T value, CancellationToken cancel = default) => Step<T, bool>(_codec, value, null, out _, cancel);

    /// <summary>Gives a value; false when no more are taken.</summary>
    public async Task<bool> NextAsync(T value, CancellationToken cancel = default) =>
        (await StepAsync<T, bool>(_codec, value, null, cancel).ConfigureAwait(false)).HasValue;

    /// <summary>Gives all values and closes the generator, or stops when no more are taken.</summary>
    public async Task SendAllAsync(IAsyncEnumerable<T> values, CancellationToken cancel = default)
    {
        await foreach (T value in values.WithCancellation(cancel).ConfigureAwait(false))
        {
            if (!await NextAsync(value, cancel).ConfigureAwait(false))
            {
                return;
            }
        }
        await CloseAsync(cancel).ConfigureAwait(false);
    }
}

/// <summary>A generator that takes a value in each step and gives another.</summary>
/// <typeparam name="TIn">What each step takes.</typeparam>
/// <typeparam name="TOut">What each step gives.</typeparam>
public sealed class GeneratorFilter<TIn, TOut> : GeneratorBase
{
    private readonly ValueCodec<TIn> _taken;
    private readonly ValueCodec<TOut> _given;

    internal GeneratorFilter(GeneratorHandle handle, ObjectHandle target, ValueCodec<TIn> taken, ValueCodec<TOut> given)
        : base(handle, target)
    {
        _taken = taken;
        _given = given;
    }

    /// <summary>One step, in the thread of the caller; false at the end.</summary>
    public bool TryNext(TIn parameter, out TOut value, CancellationToken cancel = default) =>
        Step(_taken, parameter, _given, out value, cancel);

    /// <summary>One step; no value at the end.</summary>
    public Task<(bool HasValue, TOut Value)> NextAsync(TIn parameter, CancellationToken cancel = default) =>
        StepAsync(_taken, parameter, _given, cancel);

    /// <summary>What the generator makes of these values, one by one.</summary>
    public async IAsyncEnumerable<TOut> ApplyAsync(IAsyncEnumerable<TIn> parameters, [EnumeratorCancellation] CancellationToken cancel = default)
    {
        try
        {
            await foreach (TIn parameter in parameters.WithCancellation(cancel).ConfigureAwait(false))
            {
                (bool hasValue, TOut value) = await NextAsync(parameter, cancel).ConfigureAwait(false);
                if (!hasValue)
                {
                    yield break;
                }
                yield return value;
            }
        }
        finally
        {
            Dispose();
        }
    }
}
