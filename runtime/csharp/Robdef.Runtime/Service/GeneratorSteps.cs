// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Channels;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>The request that has opened a generator.</summary>
internal readonly record struct GeneratorOrigin(KnownTypes Types, ServedSession Session, string Member);

/// <summary>
/// The steps of one generator that a service gives. One at a time, by the native runtime's promise, which brings the
/// end behind the step that runs. A session that ends cancels the step, too.
/// </summary>
internal abstract class GeneratorSteps
{
    private readonly GeneratorOrigin _origin;
    private readonly CancellationTokenRegistration _ended;
    private int _isReleased;

    protected GeneratorSteps(GeneratorOrigin origin)
    {
        _origin = origin;
        _ended = origin.Session.Token.UnsafeRegister(static steps => ((GeneratorSteps)steps!).CancelQuietly(), this);
    }

    /// <summary>Cancelled when the client breaks off or has left, not when it closes the generator.</summary>
    protected CancellationTokenSource BrokenOff { get; } = new();

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static unsafe void OnStep(nint context, nint native, RrRequestInfo* info)
    {
        GeneratorSteps steps = Context.Get<GeneratorSteps>(context);
        GeneratorOrigin origin = steps._origin;
        var request = new ServedRequest(native, *info, origin.Types, origin.Session, origin.Member, null);
        try
        {
            _ = steps.StepAsync(request);
        }
        catch (Exception exception)
        {
            request.Fail(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnEnd(nint context, int aborts) => Context.Get<GeneratorSteps>(context).Stop(aborts != 0);

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnDrop(nint context)
    {
        GeneratorSteps steps = Context.Get<GeneratorSteps>(context);
        Context.Free(context);
        steps.Stop(isBrokenOff: true);
    }

    /// <summary>Begins the work, which may refuse at once: then the function of the service fails.</summary>
    public abstract void Begin();

    /// <summary>There is no generator after all.</summary>
    public void Forget() => _ended.Unregister();

    /// <summary>Answers or fails the request, whatever happens.</summary>
    protected abstract Task StepAsync(ServedRequest request);

    /// <summary>Lets go of what the program gave, once no step runs.</summary>
    protected abstract ValueTask ReleaseAsync();

    private void Stop(bool isBrokenOff)
    {
        if (Interlocked.Exchange(ref _isReleased, 1) != 0)
        {
            return;
        }
        _ended.Unregister();
        if (isBrokenOff)
        {
            CancelQuietly();
        }
        _ = ReleaseQuietlyAsync();
    }

    private void CancelQuietly()
    {
        try
        {
            BrokenOff.Cancel();
        }
        catch (AggregateException exception)
        {
            // Of what the program has registered.
            Unhandled.Report(exception);
        }
    }

    private async Task ReleaseQuietlyAsync()
    {
        try
        {
            await ReleaseAsync().ConfigureAwait(false);
        }
        catch (OperationCanceledException)
        {
            // That is how the program's part ends.
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }
}

/// <summary>A generator that gives the values of a sequence.</summary>
#pragma warning disable CA1001 // A semaphore without a wait handle has nothing to dispose.
internal sealed class SourceSteps<T>(GeneratorOrigin origin, Func<CancellationToken, IAsyncEnumerable<T>> work, ValueCodec<T> codec)
    : GeneratorSteps(origin)
{
    private readonly SemaphoreSlim _turn = new(1);
    private IAsyncEnumerable<T>? _given;
    private IAsyncEnumerator<T>? _values;

    public override void Begin() => _given = work(BrokenOff.Token);

    protected override async Task StepAsync(ServedRequest request)
    {
        await _turn.WaitAsync().ConfigureAwait(false);
        try
        {
            _values ??= _given!.GetAsyncEnumerator(BrokenOff.Token);
            if (await _values.MoveNextAsync().ConfigureAwait(false))
            {
                request.Answer(_values.Current, codec);
            }
            else
            {
                request.AnswerEnd();
            }
        }
        catch (Exception exception)
        {
            request.Fail(exception);
        }
        finally
        {
            _turn.Release();
        }
    }

    protected override async ValueTask ReleaseAsync()
    {
        await _turn.WaitAsync().ConfigureAwait(false);
        if (_values is not null)
        {
            await _values.DisposeAsync().ConfigureAwait(false);
        }
    }
}

#pragma warning restore CA1001

/// <summary>
/// What a client gives, step by step, as a sequence: asking for the next value says that the one
/// before has been dealt with.
/// </summary>
internal sealed class Parameters<T>
{
    private readonly Channel<T> _values = Channel.CreateUnbounded<T>();
    private TaskCompletionSource? _dealtWith;

    /// <summary>No more values come: the sequence ends, or breaks off with an OperationCanceledException.</summary>
    public void End(CancellationToken brokenOff) =>
        _values.Writer.TryComplete(brokenOff.IsCancellationRequested ? new OperationCanceledException(brokenOff) : null);

    /// <summary>Hands over a value; the task ends when the next is asked for.</summary>
    public Task Give(T value)
    {
        var dealtWith = new TaskCompletionSource(TaskCreationOptions.RunContinuationsAsynchronously);
        _dealtWith = dealtWith;
        _values.Writer.TryWrite(value);
        return dealtWith.Task;
    }

    public async IAsyncEnumerable<T> ReadAsync([EnumeratorCancellation] CancellationToken cancel = default)
    {
        await foreach (T value in _values.Reader.ReadAllAsync(cancel).ConfigureAwait(false))
        {
            yield return value;
            Interlocked.Exchange(ref _dealtWith, null)?.TrySetResult();
        }
    }
}

/// <summary>A generator whose values a piece of work takes.</summary>
internal sealed class SinkSteps<T>(GeneratorOrigin origin, Func<IAsyncEnumerable<T>, CancellationToken, ValueTask> work,
    ValueCodec<T> codec) : GeneratorSteps(origin)
{
    private readonly Parameters<T> _parameters = new();
    private Task? _work;
    private bool _isTold;

    public override void Begin()
    {
        _work = work(_parameters.ReadAsync(), BrokenOff.Token).AsTask();
        if (_work.IsFaulted)
        {
            _work.GetAwaiter().GetResult();
        }
    }

    protected override Task StepAsync(ServedRequest request)
    {
        T value = request.Argument(codec);
        return StepAsync(request, value);
    }

    protected override async ValueTask ReleaseAsync()
    {
        _parameters.End(BrokenOff.Token);
        if (_work is not null && !_isTold)
        {
            await _work.ConfigureAwait(false);
        }
    }

    private async Task StepAsync(ServedRequest request, T value)
    {
        try
        {
            Task running = _work!;
            if (running.IsCompleted || await Task.WhenAny(_parameters.Give(value), running).ConfigureAwait(false) == running)
            {
                // The end, or the fault, is this step's, as it is where other languages end in the middle of one.
                _isTold = true;
                await running.ConfigureAwait(false);
                request.AnswerEnd();
                return;
            }
            request.AnswerNothing();
        }
        catch (Exception exception)
        {
            request.Fail(exception);
        }
    }
}

/// <summary>A generator that makes a value of each that it takes.</summary>
#pragma warning disable CA1001 // A semaphore without a wait handle has nothing to dispose.
internal sealed class FilterSteps<TIn, TOut>(GeneratorOrigin origin,
    Func<IAsyncEnumerable<TIn>, CancellationToken, IAsyncEnumerable<TOut>> work, ValueCodec<TIn> taken, ValueCodec<TOut> given)
    : GeneratorSteps(origin)
{
    private readonly SemaphoreSlim _turn = new(1);
    private readonly Parameters<TIn> _parameters = new();
    private IAsyncEnumerable<TOut>? _made;
    private IAsyncEnumerator<TOut>? _values;

    public override void Begin() => _made = work(_parameters.ReadAsync(), BrokenOff.Token);

    protected override Task StepAsync(ServedRequest request)
    {
        TIn value = request.Argument(taken);
        return StepAsync(request, value);
    }

    protected override async ValueTask ReleaseAsync()
    {
        _parameters.End(BrokenOff.Token);
        await _turn.WaitAsync().ConfigureAwait(false);
        if (_values is not null)
        {
            await _values.DisposeAsync().ConfigureAwait(false);
        }
    }

    private async Task StepAsync(ServedRequest request, TIn value)
    {
        await _turn.WaitAsync().ConfigureAwait(false);
        try
        {
            _values ??= _made!.GetAsyncEnumerator(BrokenOff.Token);
            _ = _parameters.Give(value);
            if (await _values.MoveNextAsync().ConfigureAwait(false))
            {
                request.Answer(_values.Current, given);
            }
            else
            {
                request.AnswerEnd();
            }
        }
        catch (Exception exception)
        {
            request.Fail(exception);
        }
        finally
        {
            _turn.Release();
        }
    }
}
#pragma warning restore CA1001
