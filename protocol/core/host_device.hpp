// FURROW_HD marks functions that are compiled for the host, and by nvcc also for the device.
#pragma once

#ifdef __CUDACC__
#define FURROW_HD __host__ __device__
#else
#define FURROW_HD
#endif
