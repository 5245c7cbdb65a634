package trik.dcml;

/**
 * A robot whose motion is a model in DCML: what a simulator needs of it, whatever the model is.
 *
 * Each class that is generated for Java implements this interface. A robot holds its parameters, its action and its
 * state, all of them 0 at first; numbers stand in the order in which the model declares their names.
 */
public interface RobotModel {
    /** The name of the model. */
    String getModelName();

    /** The names of the parameters. */
    String[] getParameterNames();

    /** The names of the actions. */
    String[] getActionNames();

    /** The names of the states. */
    String[] getStateNames();

    /** The names of the outputs, which are computed from the state and the action. */
    String[] getOutputNames();

    /** Whether a state, by its place, is an angle that wraps at a full turn. */
    boolean isAngle(int state);

    /** A copy of the parameters. */
    double[] getParameters();

    /**
     * Sets what is fixed for one robot.
     *
     * @param parameters a number for each parameter
     * @throws IllegalArgumentException if there are more or fewer
     */
    void setParameters(double[] parameters);

    /** A copy of the action. */
    double[] getAction();

    /**
     * Applies an action: it is held from now on.
     *
     * @param action a number for each action
     * @throws IllegalArgumentException if there are more or fewer
     */
    void setAction(double[] action);

    /** A copy of the state. */
    double[] getState();

    /**
     * Puts the robot into a state.
     *
     * @param state a number for each state
     * @throws IllegalArgumentException if there are more or fewer
     */
    void setState(double[] state);

    /**
     * Computes the derivative of a state under the action.
     *
     * @param state a number for each state; it need not be that of the robot
     * @param derivative where the derivatives go
     * @throws IllegalArgumentException if one of them has another size
     */
    void computeDerivative(double[] state, double[] derivative);

    /**
     * Computes the outputs of a state under the action.
     *
     * @param state a number for each state; it need not be that of the robot
     * @param outputs where the outputs go
     * @throws IllegalArgumentException if one of them has another size
     */
    void computeOutputs(double[] state, double[] outputs);

    /** One parameter; an unknown name is an IllegalArgumentException, here and in all methods that take a name. */
    default double getParameter(String name) {
        return getParameters()[place("parameter", getParameterNames(), name)];
    }

    /** Sets one parameter. */
    default void setParameter(String name, double value) {
        double[] all = getParameters();
        all[place("parameter", getParameterNames(), name)] = value;
        setParameters(all);
    }

    /** One action. */
    default double getAction(String name) {
        return getAction()[place("action", getActionNames(), name)];
    }

    /** Sets one action; the others stay. */
    default void setAction(String name, double value) {
        double[] all = getAction();
        all[place("action", getActionNames(), name)] = value;
        setAction(all);
    }

    /** One state. */
    default double getState(String name) {
        return getState()[place("state", getStateNames(), name)];
    }

    /** Sets one state; the others stay. */
    default void setState(String name, double value) {
        double[] all = getState();
        all[place("state", getStateNames(), name)] = value;
        setState(all);
    }

    /** The outputs of the state of the robot. */
    default double[] getOutputs() {
        double[] outputs = new double[getOutputNames().length];
        computeOutputs(getState(), outputs);
        return outputs;
    }

    /** One output. */
    default double getOutput(String name) {
        return getOutputs()[place("output", getOutputNames(), name)];
    }

    /**
     * Moves the robot by one step of the classical Runge-Kutta method under its action. Angles are in [-pi, pi] then.
     *
     * @param seconds how long the step is
     */
    default void step(double seconds) {
        double[] from = getState();
        double[] at = from.clone();
        double[] sum = new double[from.length];
        double[] slope = new double[from.length];
        final double[] shares = {0.0, 0.5, 0.5, 1.0};
        final double[] weights = {1.0, 2.0, 2.0, 1.0};
        for (int part = 0; part < shares.length; part++) {
            for (int i = 0; i < from.length; i++) {
                at[i] = from[i] + seconds * shares[part] * slope[i];
            }
            computeDerivative(at, slope);
            for (int i = 0; i < from.length; i++) {
                sum[i] += weights[part] * slope[i];
            }
        }
        for (int i = 0; i < from.length; i++) {
            at[i] = from[i] + seconds / 6.0 * sum[i];
            if (isAngle(i)) {
                at[i] = Math.IEEEremainder(at[i], 2.0 * Math.PI);
            }
        }
        setState(at);
    }

    /** The place of a name in a list; a name that is not there is refused. */
    static int place(String what, String[] names, String name) {
        for (int at = 0; at < names.length; at++) {
            if (names[at].equals(name)) {
                return at;
            }
        }
        throw new IllegalArgumentException(
            "there is no " + what + " " + name + "; there are " + String.join(", ", names));
    }
}
