// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;

namespace Robdef.Runtime.Native;

/// <summary>
/// Cancels a native call when a token is cancelled. The native part is made only for tokens that
/// can be.
/// </summary>
internal struct NativeCancellation(CancellationToken token)
{
    private CancellationTokenRegistration _registration;

    public nint Handle { get; private set; }

    public readonly CancellationToken Token => token;

    public unsafe void Begin()
    {
        if (!token.CanBeCanceled)
        {
            return;
        }
        token.ThrowIfCancellationRequested();
        nint error;
        Failure.Check(Functions.rr_cancellation_new(out nint handle, &error), error, KnownTypes.None);
        Handle = handle;
        _registration = token.UnsafeRegister(static state => Functions.rr_cancellation_cancel((nint)state!), handle);
    }

    /// <summary>Once, when the call has ended. Waits for a cancellation that runs.</summary>
    public void End()
    {
        if (Handle == 0)
        {
            return;
        }
        _registration.Dispose();
        Functions.rr_cancellation_release(Handle);
        Handle = 0;
    }

    /// <summary>What a failed call throws.</summary>
    public readonly Exception Failed(RobdefException error) =>
        error.Code == ErrorCode.OperationCancelled && token.IsCancellationRequested
            ? new OperationCanceledException(error.Message, error, token)
            : error;
}

/// <summary>An asynchronous native call that has begun: the context of its completion.</summary>
internal abstract unsafe class Completion
{
    private NativeCancellation _cancellation;

    protected Completion(KnownTypes types, CancellationToken cancel)
    {
        Types = types;
        _cancellation = new NativeCancellation(cancel);
        _cancellation.Begin();
    }

    protected KnownTypes Types { get; }

    public nint Cancellation => _cancellation.Handle;

    /// <summary>Ends with the call; null for none.</summary>
    public Measure? Measure { get; init; }

    /// <summary>To be given to the call; ends with it, or with Abandon.</summary>
    public RrCompletion Native => new() { Context = Context.Of(this), Done = &OnDone };

    /// <summary>The call has not begun.</summary>
    public RobdefException Abandon(in RrCompletion native, int status, nint error)
    {
        Context.Free(native.Context);
        _cancellation.End();
        RobdefException failure = Failure.Take(status, error, Types);
        Measure?.End(failure);
        return failure;
    }

    protected abstract void Succeed(nint result);

    protected abstract void Fail(Exception exception);

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnDone(nint context, nint error, nint result)
    {
        var completion = Context.Get<Completion>(context);
        Context.Free(context);
        try
        {
            if (error == 0)
            {
                completion._cancellation.End();
                completion.Measure?.End(null);
                completion.Succeed(result);
                return;
            }
            RobdefException failure = Failure.Take((int)ErrorCode.UnknownError, error, completion.Types);
            Exception seen = completion._cancellation.Failed(failure);
            completion._cancellation.End();
            completion.Measure?.End(seen);
            completion.Fail(seen);
        }
        catch (Exception exception)
        {
            completion.Fail(exception);
        }
    }
}

/// <summary>A completion that ends a task with what <paramref name="convert"/> makes of the native result.</summary>
internal sealed class TaskCompletion<T>(KnownTypes types, Func<nint, T> convert, CancellationToken cancel)
    : Completion(types, cancel)
{
    private readonly TaskCompletionSource<T> _source = new(TaskCreationOptions.RunContinuationsAsynchronously);

    public Task<T> Task => _source.Task;

    protected override void Succeed(nint result) => _source.TrySetResult(convert(result));

    protected override void Fail(Exception exception)
    {
        if (exception is OperationCanceledException cancelled)
        {
            _source.TrySetCanceled(cancelled.CancellationToken);
        }
        else
        {
            _source.TrySetException(exception);
        }
    }
}

/// <summary>A completion that ends a task with the value of an answer.</summary>
internal sealed class AnswerCompletion<T>(KnownTypes types, ValueCodec<T>? codec, CancellationToken cancel)
    : Completion(types, cancel)
{
    private readonly TaskCompletionSource<T> _source = new(TaskCreationOptions.RunContinuationsAsynchronously);

    public Task<T> Task => _source.Task;

    protected override void Succeed(nint result)
    {
        if (codec is null)
        {
            Functions.rr_data_release(result);
            _source.TrySetResult(default!);
            return;
        }
        _source.TrySetResult(Elements.Take(result, codec, Types.Registry));
    }

    protected override void Fail(Exception exception)
    {
        if (exception is OperationCanceledException cancelled)
        {
            _source.TrySetCanceled(cancelled.CancellationToken);
        }
        else
        {
            _source.TrySetException(exception);
        }
    }
}
