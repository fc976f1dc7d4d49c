// Simulates a million arms on a CUDA device and on all processors of the host. The results are bit-identical.
//
// Usage: arms [ARMS [STEPS]]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "arms.h"
#include "planetary_arm.cuh"

using Number = planetary_arm_real;

static void check(cudaError_t error) {
    if (error != cudaSuccess) {
        std::fprintf(stderr, "error: %s\n", cudaGetErrorString(error));
        std::exit(1);
    }
}

__global__ void prepare(planetary_arm_coefficients *coefficients, Number one, int *is_unfused) {
    planetary_arm_parameters parameters;
    planetary_arm_default_parameters(&parameters);
    planetary_arm_prepare(&parameters, coefficients);
    *is_unfused = planetary_arm_is_unfused(one);
}

__global__ void advance(
    Number *states, size_t arms, int steps, Number h, const planetary_arm_coefficients *coefficients
) {
    const size_t arm = blockIdx.x * size_t(blockDim.x) + threadIdx.x;
    if (arm >= arms) return;
    const planetary_arm_inputs inputs = {0};
    Number state[planetary_arm_STATES];
    for (int i = 0; i < planetary_arm_STATES; ++i) state[i] = states[arm * planetary_arm_STATES + i];
    for (int step = 0; step < steps; ++step) {
        planetary_arm_step(Number(step) * h, h, state, &inputs, coefficients);
    }
    for (int i = 0; i < planetary_arm_STATES; ++i) states[arm * planetary_arm_STATES + i] = state[i];
}

static double seconds() {
    using Clock = std::chrono::steady_clock;
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

int main(int count, char **words) {
    const size_t arms = count > 1 ? std::strtoul(words[1], nullptr, 10) : 1000000;
    const int steps = count > 2 ? std::atoi(words[2]) : 100;
    const Number h = Number(1e-5);
    if (arms == 0 || steps <= 0) {
        std::fprintf(stderr, "error: ARMS and STEPS must be positive integers\n");
        return 2;
    }
    // Each arm starts with different rates (rad/s): some meshes stay in contact, others lose contact.
    std::vector<Number> host(arms * planetary_arm_STATES, Number(0));
    for (size_t arm = 0; arm < arms; ++arm) {
        Number *state = host.data() + arm * planetary_arm_STATES;
        state[planetary_arm_STATE_X_SP_DOT] = Number(arm % 1000) * Number(1e-3);
        state[planetary_arm_STATE_X_C_DOT] = Number(arm / 1000) * Number(1e-3);
    }
    const size_t size = host.size() * sizeof(Number);
    std::vector<Number> device(host.size());
    Number *states;
    planetary_arm_coefficients *coefficients;
    int *flag, is_unfused = 0;
    check(cudaMalloc(&states, size));
    check(cudaMalloc(&coefficients, sizeof *coefficients));
    check(cudaMalloc(&flag, sizeof *flag));
    check(cudaMemcpy(states, host.data(), size, cudaMemcpyHostToDevice));
    prepare<<<1, 1>>>(coefficients, Number(1), flag);
    check(cudaMemcpy(&is_unfused, flag, sizeof is_unfused, cudaMemcpyDeviceToHost));
    if (!is_unfused) {
        std::fprintf(stderr, "error: the device fuses products and sums; compile with -fmad=false\n");
        return 1;
    }
    const int block = 128;
    const unsigned blocks = unsigned((arms + block - 1) / block);
    double begin = seconds();
    advance<<<blocks, block>>>(states, arms, steps, h, coefficients);
    check(cudaGetLastError());
    check(cudaDeviceSynchronize());
    const double device_time = seconds() - begin;
    check(cudaMemcpy(device.data(), states, size, cudaMemcpyDeviceToHost));

    const unsigned processors = std::thread::hardware_concurrency();
    std::vector<std::thread> threads;
    begin = seconds();
    for (unsigned part = 0; part < processors; ++part) {
        threads.emplace_back(
            advance_on_host, host.data(), arms * part / processors, arms * (part + 1) / processors, steps, h
        );
    }
    for (std::thread &thread : threads) thread.join();
    const double host_time = seconds() - begin;

    size_t different = 0;
    for (size_t i = 0; i < host.size(); ++i) {
        different += std::memcmp(&host[i], &device[i], sizeof(Number)) != 0;
    }
    cudaDeviceProp properties;
    check(cudaGetDeviceProperties(&properties, 0));
    std::printf(
        "%zu arms, %d steps, %zu bits per number\n%s: %.4f s\nhost, %u threads: %.4f s, %.1f times the time\n"
        "numbers that differ: %zu of %zu\n",
        arms, steps, 8 * sizeof(Number), properties.name, device_time, processors, host_time,
        host_time / device_time, different, host.size()
    );
    return different != 0;
}
