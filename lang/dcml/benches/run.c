/* What a person would write by hand for both published robots, timed: a line `NAME NANOSECONDS` for each.
 * Compiled and run by dcml_run.rs. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#define STATES 1024
#define PASSES 4000
#define PLACES 6

struct drive { double l, r; };
struct bart { double half_axis, radius, offset; };

static double states[STATES][PLACES], actions[STATES][4], rates[STATES][PLACES];

__attribute__((noinline)) static void drive(const struct drive *p, const double *x, const double *u, double *d)
{
	double ahead = p->r / 2 * (u[0] + u[1]);
	d[0] = ahead * cos(x[2]);
	d[1] = ahead * sin(x[2]);
	d[2] = p->r / p->l * (u[1] - u[0]);
}

__attribute__((noinline)) static void bart(const struct bart *p, const double *x, const double *u, double *d)
{
	double half = p->radius / 2, k = p->offset / p->half_axis;
	for (int block = 0; block < 2; block++, x += 3, d += 3, u += 2) {
		double s = sin(x[2]), c = cos(x[2]);
		d[0] = half * ((c - k * s) * u[1] + (c + k * s) * u[0]);
		d[1] = half * ((s + k * c) * u[1] + (s - k * c) * u[0]);
		d[2] = p->radius / (2 * p->half_axis) * (u[1] - u[0]);
	}
}

static void propagate(const struct drive *p, double *x, const double *u, double seconds, int steps)
{
	double h = seconds / steps, k1[3], k2[3], k3[3], k4[3], at[3];
	for (int step = 0; step < steps; step++) {
		drive(p, x, u, k1);
		for (int i = 0; i < 3; i++)
			at[i] = x[i] + h / 2 * k1[i];
		drive(p, at, u, k2);
		for (int i = 0; i < 3; i++)
			at[i] = x[i] + h / 2 * k2[i];
		drive(p, at, u, k3);
		for (int i = 0; i < 3; i++)
			at[i] = x[i] + h * k3[i];
		drive(p, at, u, k4);
		for (int i = 0; i < 3; i++)
			x[i] += h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
	}
}

static double now(void)
{
	struct timespec t;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
	return t.tv_sec * 1e9 + t.tv_nsec;
}

int main(void)
{
	struct drive d = { 0.4, 0.1 };
	struct bart b = { 0.2, 0.1, 0.05 };
	double sum = 0, begin;
	for (int i = 0; i < STATES; i++) {
		for (int j = 0; j < PLACES; j++)
			states[i][j] = sin(i * 7 + j) * 3;
		for (int j = 0; j < 4; j++)
			actions[i][j] = cos(i * 5 + j);
	}
	begin = now();
	for (int pass = 0; pass < PASSES; pass++)
		for (int i = 0; i < STATES; i++)
			drive(&d, states[i], actions[i], rates[i]);
	printf("drive %f\n", (now() - begin) / PASSES / STATES);
	sum += rates[7][0];
	begin = now();
	for (int pass = 0; pass < PASSES; pass++)
		for (int i = 0; i < STATES; i++)
			bart(&b, states[i], actions[i], rates[i]);
	printf("bart %f\n", (now() - begin) / PASSES / STATES);
	sum += rates[7][0];
	begin = now();
	for (int pass = 0; pass < PASSES / 40; pass++)
		for (int i = 0; i < STATES; i++)
			propagate(&d, states[i], actions[i], 1, 10);
	printf("propagation %f\n", (now() - begin) / (PASSES / 40) / STATES);
	sum += states[7][0];
	fprintf(stderr, "%f\n", sum);
	return 0;
}
