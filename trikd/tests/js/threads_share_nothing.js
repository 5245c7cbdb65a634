var number = 1;
var device = brick.motor(M1);
var list = [1, { a: [2] }];
function worker() {
    number += 1;
    device.setPower(number);
    list[1].a.push(number);
    Threading.sendMessage("main", JSON.stringify(list));
    return;
}
function start() {
    number = 10;
    Threading.startThread("w", worker);
    Threading.joinThread("w");
    print(Threading.receiveMessage(false), " ", number, " ", JSON.stringify(list));
    print("[", Threading.receiveMessage(false), "]");
}
var main = function() { start(); }
main();
//> [1,{"a":[2,11]}] 10 [1,{"a":[2]}]
//> []
//= motors/M1/value 11
