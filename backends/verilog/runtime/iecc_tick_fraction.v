// Divides a clock by a fraction, exactly and without division.
//
// Every clock lasts ADD / MODULUS units of time. The sum of these is kept modulo MODULUS, and `wrap`
// is high in each clock in which it passes a whole unit: in floor(k * ADD / MODULUS) of the first k
// clocks after reset. The error never grows; the distance of ticks varies by one clock.
module iecc_tick_fraction #(
    parameter WIDTH = 16,
    parameter [WIDTH-1:0] ADD = 16'd3,
    parameter [WIDTH-1:0] REST = 16'd9997  // MODULUS - ADD
) (
    input  wire clk,
    input  wire rst,
    output wire wrap
);

    reg [WIDTH-1:0] sum;

    assign wrap = sum >= REST;

    always @(posedge clk)
        if (rst)
            sum <= {WIDTH{1'b0}};
        else
            sum <= wrap ? sum - REST : sum + ADD;

endmodule
