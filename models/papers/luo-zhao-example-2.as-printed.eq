# Luo & Zhao, example 2: the equations as printed, with their misprints.
# Names are those of luo-zhao-example-2.toml; lambda is the multiplier of the only constraint.
# The plane of the model: omega = sin(t)/10, omega' = cos(t)/10, its angle (1 - cos(t))/10; v_O' along inertial axes is
# (cos(t)/5, sin(t)/10), its derivative (-sin(t)/5, cos(t)/10).
# Equations whose print is not known in detail have the corrected form, and a comment says so.

# The blade.
4.5: y' = x'*tan(theta)
# Routh's equations for x, y, theta. The third contains no multiplier.
# Misprints: lost dots, x for x'', v_O' for its derivative. Which of the dots are lost is not known; here all of them.
4.7: (M + m)*x - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta)) = -m'*u*cos(alpha + theta) + (cos(t)/10)*((M + m)*y + (a*M + b*m)*sin(theta)) - (M + m)*((cos(t)/5)*cos((1 - cos(t))/10) + (sin(t)/10)*sin((1 - cos(t))/10)) + (sin(t)/10)^2*((M + m)*x + (a*M + b*m)*cos(theta)) + 2*(sin(t)/10)*((M + m)*y' + (a*M + b*m)*theta'*cos(theta)) - lambda*tan(theta)
# The same: y for y'', v_O' for its derivative.
4.8: (M + m)*y + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta)) = -m'*u*sin(alpha + theta) - (cos(t)/10)*((M + m)*x + (a*M + b*m)*cos(theta)) - (M + m)*((sin(t)/10)*cos((1 - cos(t))/10) - (cos(t)/5)*sin((1 - cos(t))/10)) + (sin(t)/10)^2*((M + m)*y + (a*M + b*m)*sin(theta)) - 2*(sin(t)/10)*((M + m)*x' - (a*M + b*m)*theta'*sin(theta)) + lambda
# Misprint: y' and x' for y'' and x'' on the left; the right side is correct as printed.
4.9: (J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y'*cos(theta) - x'*sin(theta)) = -m'*u*b*sin(alpha) - (cos(t)/10)*(J + a^2*M + b^2*m + (a*M + b*m)*(x*cos(theta) + y*sin(theta))) - (a*M + b*m)*(((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10))*cos(theta) - ((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10))*sin(theta)) + (sin(t)/10)^2*(a*M + b*m)*(y*cos(theta) - x*sin(theta)) - 2*(sin(t)/10)*(a*M + b*m)*(x'*cos(theta) + y'*sin(theta))
# RECONSTRUCTED from here on: the content of (4.10)-(4.13) is known in part only. (4.10): lambda taken out of (4.7) and (4.8),
# cos(theta) times the first and sin(theta) times the second. Its term -2 omega (x' sin(theta) - y' cos(theta)) vanishes by (4.5).
# Misprints: the lost dots of (4.7).
4.10: (M + m)*(x*cos(theta) + y*sin(theta)) - (a*M + b*m)*theta'^2 = -m'*u*cos(alpha) + (cos(t)/10)*(M + m)*(y*cos(theta) - x*sin(theta)) - (M + m)*(((cos(t)/5)*cos((1 - cos(t))/10) + (sin(t)/10)*sin((1 - cos(t))/10))*cos(theta) + ((sin(t)/10)*cos((1 - cos(t))/10) - (cos(t)/5)*sin((1 - cos(t))/10))*sin(theta)) + (sin(t)/10)^2*((M + m)*(x*cos(theta) + y*sin(theta)) + a*M + b*m) - 2*(sin(t)/10)*(M + m)*(x'*sin(theta) - y'*cos(theta)) + 2*(sin(t)/10)*(a*M + b*m)*theta'
# (4.10) over cos(theta), with y' and y'' put in from (4.5). A guess at what is printed.
# Lost dots are known here and in (4.12) too (x, y, v_O' for x'', y'' and the derivative of v_O'), but not the equations
# around them: corrected form.
4.11: (M + m)*(x''/cos(theta)^2 + x'*theta'*sin(theta)/cos(theta)^3) - (a*M + b*m)*theta'^2/cos(theta) = -m'*u*cos(alpha)/cos(theta) + (cos(t)/10)*(M + m)*(y - x*tan(theta)) - (M + m)*(((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10)) + ((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10))*tan(theta)) + (sin(t)/10)^2*((M + m)*(x + y*tan(theta)) + (a*M + b*m)/cos(theta)) + 2*(sin(t)/10)*(a*M + b*m)*theta'/cos(theta)
# (4.9) with y' and y'' put in. A guess at what is printed: corrected form.
4.12: (J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*x'*theta'/cos(theta) = -m'*u*b*sin(alpha) - (cos(t)/10)*(J + a^2*M + b^2*m + (a*M + b*m)*(x*cos(theta) + y*sin(theta))) - (a*M + b*m)*(((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10))*cos(theta) - ((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10))*sin(theta)) + (sin(t)/10)^2*(a*M + b*m)*(y*cos(theta) - x*sin(theta)) - 2*(sin(t)/10)*(a*M + b*m)*x'/cos(theta)
# The multiplier from (4.8), with y'' put in. A guess at what is printed.
# No misprint is known: corrected form.
4.13: lambda = (M + m)*(x''*tan(theta) + x'*theta'/cos(theta)^2) + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta)) + m'*u*sin(alpha + theta) + (cos(t)/10)*((M + m)*x + (a*M + b*m)*cos(theta)) + (M + m)*((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10)) - (sin(t)/10)^2*((M + m)*y + (a*M + b*m)*sin(theta)) + 2*(sin(t)/10)*((M + m)*x' - (a*M + b*m)*theta'*sin(theta))
