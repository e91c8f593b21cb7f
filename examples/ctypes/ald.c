/* The ALD reactor in a chamber: a simulation that answers the valves and heaters of the controller,
 * presses Start once, and prints a line whenever an output changes. */
#include "ALD_Reactor.h"
#include <stdio.h>
#include <string.h>

#define PERIOD_MS 1
#define LENGTH_MS 3000

typedef struct {
    double pressure_mbar;
    double bottle_celsius;
    double reactor_celsius;
} chamber;

/* What a millisecond does: pumps empty the chamber through open vacuum valves; without them nitrogen fills it. */
static void advance(chamber *c, const ALD_Reactor_outputs *out) {
    if (out->VV1 || out->VV2)
        c->pressure_mbar += (0.1 - c->pressure_mbar) * 0.05;
    else if (out->mfcwater)
        c->pressure_mbar += (1020.0 - c->pressure_mbar) * 0.01;
    c->bottle_celsius += ((out->heaterson ? 90.0 : 20.0) - c->bottle_celsius) * 0.01;
    c->reactor_celsius += ((out->reactorheater ? 250.0 : 20.0) - c->reactor_celsius) * 0.01;
}

static void sense(const chamber *c, ALD_Reactor_inputs *in) {
    in->TP1 = c->bottle_celsius > 70.0;
    in->TR = c->reactor_celsius > 200.0;
    in->Pressure_Switch = c->pressure_mbar < 1.0;
    in->Atmosphere = c->pressure_mbar > 1000.0;
}

static void show(int t_ms, const ALD_Reactor_outputs *out, const ALD_Reactor_state *state) {
    printf("%d,%d,%d,%d,%d,%d,%d,%d,%d\n", t_ms, out->SV1, out->SV4, out->VV1, out->VV2, out->heaterson,
           out->reactorheater, out->mfcwater, (int)state->tags.cycles.ACC);
}

int main(void) {
    static ALD_Reactor_state controller;
    ALD_Reactor_inputs in = {0};
    ALD_Reactor_outputs out = {0}, before;
    chamber c = {1013.0, 20.0, 20.0};
    int batches = 0;

    ALD_Reactor_init(&controller);
    in.Stop = true;
    in.heateron = true;
    puts("t_ms,SV1,SV4,VV1,VV2,heaterson,reactorheater,mfcwater,cycles");
    for (int t_ms = 0; t_ms <= LENGTH_MS; t_ms += PERIOD_MS) {
        in.Start = t_ms >= 100 && t_ms < 150;
        sense(&c, &in);
        before = out;
        int fault = ALD_Reactor_scan(&controller, &in, &out, (uint64_t)t_ms * 1000000);
        if (fault) {
            printf("%s in %s\n", ALD_Reactor_fault_text(fault), ALD_Reactor_fault_place(&controller));
            return 1;
        }
        if (memcmp(&before, &out, sizeof out) != 0 || t_ms == 0)
            show(t_ms, &out, &controller);
        batches += before.heaterson && !out.heaterson;
        advance(&c, &out);
    }
    printf("batches: %d\n", batches);
    return 0;
}
