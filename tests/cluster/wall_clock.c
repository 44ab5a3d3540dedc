/* A machine whose wall clock is set about: every 1.5 s a year ahead, ten years back, or right.

   Loaded before a program (LD_PRELOAD), it answers in place of the C library. Only the wall clock
   lies; by the clock that cannot be set, all programs of the machine see the same jumps. */
#define _GNU_SOURCE
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static const long SECONDS[] = {0, 31000000, -315000000};

static long error_of_the_wall_clock(void) {
    struct timespec now;
    syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
    long tenths = now.tv_sec * 10 + now.tv_nsec / 100000000;
    return SECONDS[tenths / 15 % 3];
}

int clock_gettime(clockid_t clock, struct timespec *time) {
    int status = (int)syscall(SYS_clock_gettime, clock, time);
    if (status == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
        time->tv_sec += error_of_the_wall_clock();
    return status;
}

int gettimeofday(struct timeval *time, void *zone) {
    int status = (int)syscall(SYS_gettimeofday, time, zone);
    if (status == 0)
        time->tv_sec += error_of_the_wall_clock();
    return status;
}

time_t time(time_t *where) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (where)
        *where = now.tv_sec;
    return now.tv_sec;
}
