using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace Beltrami
{
    /// <summary>Arrays that stay where they are for the time of a call, and memory for its
    /// number of cancelling.</summary>
    internal sealed class Held : IDisposable
    {
        readonly List<GCHandle> handles = new List<GCHandle>();

        /// <summary>The memory of an array, or a null pointer.</summary>
        public IntPtr Pin(Array array)
        {
            if (array == null || array.Length == 0) return IntPtr.Zero;
            GCHandle handle = GCHandle.Alloc(array, GCHandleType.Pinned);
            handles.Add(handle);
            return handle.AddrOfPinnedObject();
        }

        /// <summary>A buffer of an array of numbers; of none a buffer that is left out.</summary>
        public NativeBuffer Buffer(Array array)
        {
            NativeBuffer buffer = new NativeBuffer();
            if (array == null) return buffer;
            buffer.Data = Pin(array);
            buffer.Type = (int)ScalarOf(array);
            return buffer;
        }

        public static Scalar ScalarOf(Array array)
        {
            if (array is float[]) return Scalar.F32;
            if (array is double[]) return Scalar.F64;
            if (array is int[]) return Scalar.U32;  // negative ones are out of range there
            if (array is long[]) return Scalar.U64;
            if (array is ushort[]) return Scalar.U16;
            throw new ArgumentException(
                "give arrays of float, double, int, long or ushort, not " + array.GetType().Name);
        }

        public void Dispose()
        {
            foreach (GCHandle handle in handles) handle.Free();
            handles.Clear();
        }
    }
}
