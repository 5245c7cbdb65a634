// The yardstick of the benchmark plan: RRT of OMPL in its space of controls, with the same robot, room and numbers.
// Prints for each seed: seconds, steps of the solver, whether a path was found, and its length in seconds; at the end
// steps per second of propagation alone.
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/control/ODESolver.h>
#include <ompl/control/SimpleSetup.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ob = ompl::base;
namespace oc = ompl::control;

// Half the thickness of the wall, the radius of the robot and the margin of the other side.
static const double near_wall = 0.025 + 0.15 + 0.01, near_border = 0.15 + 0.01;
static unsigned long checked = 0;

static void slope(const oc::ODESolver::StateType &q, const oc::Control *control, oc::ODESolver::StateType &d)
{
    const double *u = control->as<oc::RealVectorControlSpace::ControlType>()->values;
    d.resize(3);
    d[0] = u[0] * std::cos(q[2]);
    d[1] = u[0] * std::sin(q[2]);
    d[2] = u[1];
}

static void wrap(const ob::State *, const oc::Control *, const double, ob::State *result)
{
    ob::SO2StateSpace space;
    space.enforceBounds(result->as<ob::SE2StateSpace::StateType>()->as<ob::SO2StateSpace::StateType>(1));
}

static bool is_free(const ob::State *state)
{
    ++checked;
    const auto *at = state->as<ob::SE2StateSpace::StateType>();
    const double x = at->getX(), y = at->getY();
    if (x < near_border || x > 4 - near_border || y < near_border || y > 3 - near_border)
        return false;
    const double dx = std::max(0.0, std::fabs(x - 2) - 0.025), dy = std::max(0.0, y - 2.4);
    return dx * dx + dy * dy > (near_wall - 0.025) * (near_wall - 0.025);
}

class Place : public ob::GoalSampleableRegion
{
public:
    explicit Place(const ob::SpaceInformationPtr &si) : ob::GoalSampleableRegion(si) { setThreshold(0.1); }
    double distanceGoal(const ob::State *state) const override
    {
        const auto *at = state->as<ob::SE2StateSpace::StateType>();
        return std::hypot(at->getX() - 3.5, at->getY() - 2.5);
    }
    void sampleGoal(ob::State *state) const override
    {
        auto *at = state->as<ob::SE2StateSpace::StateType>();
        at->setXY(3.5, 2.5);
        at->setYaw(random_.uniformReal(-M_PI, M_PI));
    }
    unsigned int maxSampleCount() const override { return 1000000; }

private:
    mutable ompl::RNG random_;
};

int main(int argc, char **argv)
{
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    const int seeds = argc > 1 ? std::atoi(argv[1]) : 20;
    auto space = std::make_shared<ob::SE2StateSpace>();
    ob::RealVectorBounds bounds(2);
    bounds.setLow(0);
    bounds.setHigh(0, 4);
    bounds.setHigh(1, 3);
    space->setBounds(bounds);
    space->setSubspaceWeight(1, 0.2);
    auto controls = std::make_shared<oc::RealVectorControlSpace>(space, 2);
    ob::RealVectorBounds range(2);
    range.setLow(0, 0);
    range.setHigh(0, 1);
    range.setLow(1, -2);
    range.setHigh(1, 2);
    controls->setBounds(range);
    using Clock = std::chrono::steady_clock;
    for (int seed = 1; seed <= seeds; ++seed)
    {
        oc::SimpleSetup setup(controls);
        auto si = setup.getSpaceInformation();
        auto solver = std::make_shared<oc::ODEBasicSolver<>>(si, slope, 0.05);
        setup.setStatePropagator(oc::ODESolver::getStatePropagator(solver, wrap));
        setup.setStateValidityChecker(is_free);
        si->setPropagationStepSize(0.05);
        si->setMinMaxControlDuration(2, 20);
        ob::ScopedState<ob::SE2StateSpace> start(space);
        start->setXY(0.5, 0.5);
        start->setYaw(0);
        setup.addStartState(start);
        setup.setGoal(std::make_shared<Place>(si));
        auto planner = std::make_shared<oc::RRT>(si);
        planner->setGoalBias(0.05);
        setup.setPlanner(planner);
        setup.setup();
        checked = 0;
        const auto from = Clock::now();
        const bool found = setup.solve(20.0) == ob::PlannerStatus::EXACT_SOLUTION;
        const std::chrono::duration<double> seconds = Clock::now() - from;
        const double length = found ? setup.getSolutionPath().length() : 0;
        std::printf("run %.9f %lu %d %.3f\n", seconds.count(), checked, found, length);
    }
    oc::SpaceInformation si(space, controls);
    auto shared = std::shared_ptr<oc::SpaceInformation>(&si, [](oc::SpaceInformation *) {});
    auto solver = std::make_shared<oc::ODEBasicSolver<>>(shared, slope, 0.05);
    si.setStatePropagator(oc::ODESolver::getStatePropagator(solver, wrap));
    si.setStateValidityChecker([](const ob::State *) { return true; });
    si.setPropagationStepSize(0.05);
    si.setMinMaxControlDuration(2, 20);
    si.setup();
    ob::State *a = si.allocState(), *b = si.allocState();
    oc::Control *u = si.allocControl();
    u->as<oc::RealVectorControlSpace::ControlType>()->values[0] = 0.5;
    u->as<oc::RealVectorControlSpace::ControlType>()->values[1] = 0.3;
    a->as<ob::SE2StateSpace::StateType>()->setXY(1, 1);
    a->as<ob::SE2StateSpace::StateType>()->setYaw(0);
    const int calls = 100000;
    double best = 1e9;
    for (int round = 0; round < 5; ++round)
    {
        const auto from = Clock::now();
        for (int call = 0; call < calls; ++call)
            si.propagate(a, u, 10, b);
        const std::chrono::duration<double> seconds = Clock::now() - from;
        best = std::min(best, seconds.count());
    }
    std::printf("propagations %.1f\n", calls / best);
    si.freeControl(u);
    si.freeState(a);
    si.freeState(b);
    return 0;
}
