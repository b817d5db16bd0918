# Luo & Zhao, example 2: the equations as they must read.
# Names are those of luo-zhao-example-2.toml; lambda is the multiplier of the only constraint.
# The plane of the model: omega = sin(t)/10, omega' = cos(t)/10, its angle (1 - cos(t))/10; v_O' along inertial axes is
# (cos(t)/5, sin(t)/10), its derivative (-sin(t)/5, cos(t)/10).
# Checked against the equations that the program derives.

# The blade.
4.5: y' = x'*tan(theta)
# Routh's equations for x, y, theta. The third contains no multiplier.
4.7: (M + m)*x'' - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta)) = -m'*u*cos(alpha + theta) + (cos(t)/10)*((M + m)*y + (a*M + b*m)*sin(theta)) - (M + m)*((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10)) + (sin(t)/10)^2*((M + m)*x + (a*M + b*m)*cos(theta)) + 2*(sin(t)/10)*((M + m)*y' + (a*M + b*m)*theta'*cos(theta)) - lambda*tan(theta)
4.8: (M + m)*y'' + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta)) = -m'*u*sin(alpha + theta) - (cos(t)/10)*((M + m)*x + (a*M + b*m)*cos(theta)) - (M + m)*((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10)) + (sin(t)/10)^2*((M + m)*y + (a*M + b*m)*sin(theta)) - 2*(sin(t)/10)*((M + m)*x' - (a*M + b*m)*theta'*sin(theta)) + lambda
4.9: (J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y''*cos(theta) - x''*sin(theta)) = -m'*u*b*sin(alpha) - (cos(t)/10)*(J + a^2*M + b^2*m + (a*M + b*m)*(x*cos(theta) + y*sin(theta))) - (a*M + b*m)*(((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10))*cos(theta) - ((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10))*sin(theta)) + (sin(t)/10)^2*(a*M + b*m)*(y*cos(theta) - x*sin(theta)) - 2*(sin(t)/10)*(a*M + b*m)*(x'*cos(theta) + y'*sin(theta))
# RECONSTRUCTED from here on: the content of (4.10)-(4.13) is known in part only. (4.10): lambda taken out of (4.7) and (4.8),
# cos(theta) times the first and sin(theta) times the second. Its term -2 omega (x' sin(theta) - y' cos(theta)) vanishes by (4.5).
4.10: (M + m)*(x''*cos(theta) + y''*sin(theta)) - (a*M + b*m)*theta'^2 = -m'*u*cos(alpha) + (cos(t)/10)*(M + m)*(y*cos(theta) - x*sin(theta)) - (M + m)*(((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10))*cos(theta) + ((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10))*sin(theta)) + (sin(t)/10)^2*((M + m)*(x*cos(theta) + y*sin(theta)) + a*M + b*m) - 2*(sin(t)/10)*(M + m)*(x'*sin(theta) - y'*cos(theta)) + 2*(sin(t)/10)*(a*M + b*m)*theta'
# (4.10) over cos(theta), with y' and y'' put in from (4.5). A guess at what is printed.
4.11: (M + m)*(x''/cos(theta)^2 + x'*theta'*sin(theta)/cos(theta)^3) - (a*M + b*m)*theta'^2/cos(theta) = -m'*u*cos(alpha)/cos(theta) + (cos(t)/10)*(M + m)*(y - x*tan(theta)) - (M + m)*(((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10)) + ((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10))*tan(theta)) + (sin(t)/10)^2*((M + m)*(x + y*tan(theta)) + (a*M + b*m)/cos(theta)) + 2*(sin(t)/10)*(a*M + b*m)*theta'/cos(theta)
# (4.9) with y' and y'' put in. A guess at what is printed.
4.12: (J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*x'*theta'/cos(theta) = -m'*u*b*sin(alpha) - (cos(t)/10)*(J + a^2*M + b^2*m + (a*M + b*m)*(x*cos(theta) + y*sin(theta))) - (a*M + b*m)*(((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10))*cos(theta) - ((-sin(t)/5)*cos((1 - cos(t))/10) + (cos(t)/10)*sin((1 - cos(t))/10))*sin(theta)) + (sin(t)/10)^2*(a*M + b*m)*(y*cos(theta) - x*sin(theta)) - 2*(sin(t)/10)*(a*M + b*m)*x'/cos(theta)
# The multiplier from (4.8), with y'' put in. A guess at what is printed.
4.13: lambda = (M + m)*(x''*tan(theta) + x'*theta'/cos(theta)^2) + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta)) + m'*u*sin(alpha + theta) + (cos(t)/10)*((M + m)*x + (a*M + b*m)*cos(theta)) + (M + m)*((cos(t)/10)*cos((1 - cos(t))/10) - (-sin(t)/5)*sin((1 - cos(t))/10)) - (sin(t)/10)^2*((M + m)*y + (a*M + b*m)*sin(theta)) + 2*(sin(t)/10)*((M + m)*x' - (a*M + b*m)*theta'*sin(theta))
