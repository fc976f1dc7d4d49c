"""Compiles CUDA headers with NVRTC: python3 compile.py REAL FILE.cuh NAME ... Prints a line for each: the name, and how many
products and fused operations its machine-independent code contains. The last line is the number of fused operations by
default, of the smallest model that has any."""

import ctypes
import glob
import os
import sys

import nvidia.cuda_nvrtc as package

FOLDER = os.path.join(list(package.__path__)[0], "lib")
NVRTC = ctypes.CDLL(glob.glob(os.path.join(FOLDER, "libnvrtc.so.*"))[0])


def read(size_function, function, program):
    size = ctypes.c_size_t()
    size_function(program, ctypes.byref(size))
    text = ctypes.create_string_buffer(size.value)
    function(program, text)
    return text.value.decode()


def compile(source, options):
    program = ctypes.c_void_p()
    created = NVRTC.nvrtcCreateProgram(ctypes.byref(program), source.encode(), b"test.cu", 0, None, None)
    assert created == 0
    words = [option.encode() for option in options]
    result = NVRTC.nvrtcCompileProgram(program, len(words), (ctypes.c_char_p * len(words))(*words))
    log = read(NVRTC.nvrtcGetProgramLogSize, NVRTC.nvrtcGetProgramLog, program)
    if result or log.strip():
        sys.exit(log)
    return read(NVRTC.nvrtcGetPTXSize, NVRTC.nvrtcGetPTX, program)


KERNEL = """
extern "C" __global__ void move(NAME_parameters *p, NAME_coefficients *c, NAME_inputs *u, NAME_real *y, NAME_real *out, int *flag) {
    NAME_prepare(p, c);
    NAME_rates(y[0], y, u, c, out);
    *flag = NAME_is_unfused(y[0]);
}
"""

real = sys.argv[1]
options = ["--std=c++17", "--gpu-architecture=compute_80"]
programs = []
for path, name in zip(sys.argv[2::2], sys.argv[3::2]):
    with open(path, encoding="utf-8") as file:
        source = file.read() + KERNEL.replace("NAME", name)
    own = [*options, f"-D{name}_REAL={real}"]
    unfused = compile(source, [*own, "--fmad=false"])
    print(name, unfused.count("mul."), unfused.count("fma."))
    programs.append((source, own))
programs.sort(key=lambda program: len(program[0]))
fused = (compile(source, [*own, "--fmad=true"]).count("fma.") for source, own in programs)
print(next(filter(None, fused), 0))
